#include "common/window/controls/region_control.h"

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

const PictureArea kArea{100.0, 50.0, 400.0, 200.0};
const Box kBounds{{-1.0, -2.0, -3.0}, {1.0, 2.0, 3.0}};
const Box kBox{{-0.5, -0.6, -0.7}, {0.25, 0.35, 0.45}};

class RegionControlTest : public ::testing::TestWithParam<Projection> {
 protected:
  RegionControlTest() {
    camera_ = make_camera(kBounds, {.azimuth = 35.0, .elevation = 25.0}, 2.0, GetParam());
  }

  bool send(const InputEvent& event) { return control_.handle(event, kArea, camera_, kBounds); }
  bool move(const Vec3& at) { return send({.kind = InputKind::kMove, .x = at.x, .y = at.y}); }
  bool press() { return send({.kind = InputKind::kPress, .button = MouseButton::kLeft}); }
  bool release() { return send({.kind = InputKind::kRelease, .button = MouseButton::kLeft}); }
  /// Where `x` is drawn in the window.
  [[nodiscard]] Vec3 shown(const Vec3& x) const {
    return project(camera_, x, 400, 200) + Vec3(kArea.left, kArea.top, 0.0);
  }
  /// The middle of a face: `side` 0 of the lower, 1 of the upper one.
  static Vec3 face(const Box& box, int axis, int side) {
    Vec3 at = box.center();
    at[axis] = side == 0 ? box.lower[axis] : box.upper[axis];
    return at;
  }

  RegionControl control_{kBox};
  Camera camera_;
};

TEST_P(RegionControlTest, AFaceGoesWhereItIsDraggedAndNothingElseDoes) {
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      control_ = RegionControl(kBox);
      Vec3 to = face(kBox, axis, side);
      to[axis] += side == 0 ? -0.2 : 0.2;
      move(shown(face(kBox, axis, side)));
      ASSERT_TRUE(press());
      ASSERT_TRUE(move(shown(to)));
      ASSERT_TRUE(release());
      Box wanted = kBox;
      (side == 0 ? wanted.lower : wanted.upper)[axis] = to[axis];
      EXPECT_NEAR(glm::distance(control_.box()->lower, wanted.lower), 0.0, 1e-9) << axis << side;
      EXPECT_NEAR(glm::distance(control_.box()->upper, wanted.upper), 0.0, 1e-9) << axis << side;
      for (int other = 0; other < 3; ++other) {
        if (other == axis) continue;  // the others to the last bit
        EXPECT_EQ(control_.box()->lower[other], kBox.lower[other]);
        EXPECT_EQ(control_.box()->upper[other], kBox.upper[other]);
      }
    }
  }
}

TEST_P(RegionControlTest, FacesStayWithinTheBoundsAndApart) {
  move(shown(face(kBox, 2, 1)));
  ASSERT_TRUE(press());
  move(shown(face(kBox, 2, 1) + Vec3(0.0, 0.0, 4.0)));
  EXPECT_EQ(control_.box()->upper.z, kBounds.upper.z);
  move(shown(face(kBox, 2, 1) - Vec3(0.0, 0.0, 4.0)));
  EXPECT_GT(control_.box()->upper.z, control_.box()->lower.z);
  EXPECT_LT(control_.box()->upper.z, control_.box()->lower.z + 0.02);
}

TEST_P(RegionControlTest, TheMiddleTakesTheBoxAlong) {
  move(shown(kBox.center()));
  ASSERT_TRUE(press());
  const Vec3 by = 0.1 * camera_.axes[0] + 0.05 * camera_.axes[1];
  move(shown(kBox.center() + by));
  EXPECT_NEAR(glm::distance(control_.box()->lower, kBox.lower + by), 0.0, 1e-9);
  EXPECT_NEAR(glm::distance(control_.box()->upper, kBox.upper + by), 0.0, 1e-9);
  // Never out of the bounds, and never smaller.
  move(shown(kBox.center() + 30.0 * camera_.axes[0]));
  EXPECT_NEAR(glm::distance(control_.box()->size(), kBox.size()), 0.0, 1e-12);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_GE(control_.box()->lower[axis], kBounds.lower[axis] - 1e-12);
    EXPECT_LE(control_.box()->upper[axis], kBounds.upper[axis] + 1e-12);
  }
}

TEST_P(RegionControlTest, PressesBesideADotAreNotForTheBox) {
  move(shown(face(kBox, 0, 1)) + Vec3(12.0, 12.0, 0.0));
  EXPECT_FALSE(press());
  control_ = RegionControl();
  move(shown(face(kBox, 0, 1)));
  EXPECT_FALSE(press());  // there is no box
}

TEST_P(RegionControlTest, TwoCornersMakeABoxAndFurtherOnesMoveTheNearest) {
  control_ = RegionControl();
  (void)control_.put_corner({0.5, -0.25, 1.0});
  EXPECT_FALSE(control_.box());
  (void)control_.put_corner({-0.5, 0.75, 2.0});
  ASSERT_TRUE(control_.box());
  EXPECT_EQ(control_.box()->lower, Vec3(-0.5, -0.25, 1.0));
  EXPECT_EQ(control_.box()->upper, Vec3(0.5, 0.75, 2.0));
  (void)control_.put_corner({0.625, 0.875, 0.5});
  EXPECT_EQ(control_.box()->lower, Vec3(-0.5, -0.25, 0.5));
  EXPECT_EQ(control_.box()->upper, Vec3(0.625, 0.875, 2.0));
}

INSTANTIATE_TEST_SUITE_P(Region, RegionControlTest,
                         ::testing::Values(Projection::kOrthographic, Projection::kPerspective));

TEST(Region, HasADotInEachFaceAndInItsMiddle) {
  EXPECT_EQ(RegionControl(kBox).dots().size(), 7U);
  EXPECT_TRUE(RegionControl().dots().empty());
}

}  // namespace
}  // namespace palpate::test
