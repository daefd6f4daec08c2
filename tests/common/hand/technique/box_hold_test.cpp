#include "common/hand/technique/box_hold.h"

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

const Box kBounds{{-1.0, -2.0, -3.0}, {1.0, 2.0, 3.0}};
const Box kBox{{-0.5, -0.6, -0.7}, {0.25, 0.35, 0.45}};
constexpr double kReach = 0.1;

Vec3 middle_of(BoxFace face) {
  Vec3 at = kBox.center();
  const int axis = static_cast<int>(face / 2);
  at[axis] = face % 2 == 0 ? kBox.lower[axis] : kBox.upper[axis];
  return at;
}

double& side_of(Box& box, BoxFace face) {
  return (face % 2 == 0 ? box.lower : box.upper)[static_cast<int>(face / 2)];
}

TEST(BoxHold, ThePressedFaceGoesWhereTheHandIsAndNothingElseDoes) {
  for (BoxFace face = 0; face < kBoxFaces; ++face) {
    const int axis = static_cast<int>(face / 2);
    const double out = face % 2 == 0 ? -1.0 : 1.0;
    BoxHold hold;
    Box box = kBox;
    Vec3 hand = middle_of(face);
    hand[axis] += 0.4 * kReach * out;
    hold.follow(false, hand, kReach, kBounds, box);
    EXPECT_EQ(box.lower, kBox.lower);
    EXPECT_EQ(box.upper, kBox.upper);
    hold.follow(true, hand, kReach, kBounds, box);
    // The hand may leave the face sideways: it holds the one that it took.
    hand[axis] += 0.3 * out;
    hand[(axis + 1) % 3] += 1.1;
    hold.follow(true, hand, kReach, kBounds, box);
    ASSERT_EQ(hold.held(), face);
    Box wanted = kBox;
    side_of(wanted, face) = hand[axis];
    EXPECT_EQ(box.lower, wanted.lower) << face;  // to the last bit
    EXPECT_EQ(box.upper, wanted.upper) << face;
    hold.follow(false, hand, kReach, kBounds, box);
    hand[axis] += 0.1 * out;
    hold.follow(false, hand, kReach, kBounds, box);
    EXPECT_EQ(box.lower, wanted.lower);
    EXPECT_EQ(box.upper, wanted.upper);
    EXPECT_FALSE(hold.held());
  }
}

TEST(BoxHold, APressAwayFromAllFacesHoldsNoneHoweverFarItIsDragged) {
  BoxHold hold;
  Box box = kBox;
  Vec3 hand = middle_of(1) + Vec3(1.5 * kReach, 0.0, 0.0);
  hold.follow(true, hand, kReach, kBounds, box);
  hand.x = kBox.upper.x;  // the button is down still
  hold.follow(true, hand, kReach, kBounds, box);
  EXPECT_FALSE(hold.held());
  EXPECT_EQ(box.upper, kBox.upper);
  // Beside the rectangle of a face, in its plane.
  hold.follow(false, hand, kReach, kBounds, box);
  hand = {kBox.upper.x, kBox.upper.y + 1.5 * kReach, 0.0};
  hold.follow(true, hand, kReach, kBounds, box);
  EXPECT_FALSE(hold.held());
}

TEST(BoxHold, FacesStayWithinTheBoundsAndApart) {
  BoxHold hold;
  Box box = kBox;
  Vec3 hand = middle_of(5);
  hold.follow(true, hand, kReach, kBounds, box);
  hand.z = 7.0;
  hold.follow(true, hand, kReach, kBounds, box);
  EXPECT_EQ(box.upper.z, kBounds.upper.z);
  hand.z = -7.0;
  hold.follow(true, hand, kReach, kBounds, box);
  EXPECT_GT(box.upper.z, box.lower.z);
  EXPECT_LT(box.upper.z, box.lower.z + 0.01);
  EXPECT_EQ(box.lower.z, kBox.lower.z);
}

TEST(BoxHold, ABoxFromBeyondTheBoundsIsNotPulledIn) {
  BoxHold hold;
  Box box = kBox;
  box.upper.x = 5.0;
  hold.follow(true, {5.0, 0.0, 0.0}, kReach, kBounds, box);
  EXPECT_EQ(box.upper.x, 5.0);
}

TEST(BoxHold, ItsTextIsThatOfTheOption) {
  EXPECT_EQ(box_text({{-0.5, 0.0, 1.25}, {1.0, 2.0, 3.0}}), "-0.5,0,1.25,1,2,3");
}

}  // namespace
}  // namespace palpate::test
