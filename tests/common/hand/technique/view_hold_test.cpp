#include <gtest/gtest.h>

#include "common/hand/technique/box_hold.h"

namespace palpate::test {
namespace {

TEST(ViewHold, CarriesThePlaceThatWasTakenWithTheHand) {
  ViewHold hold;
  EXPECT_FALSE(hold.follow(false, Vec3(5.0, 0.0, 0.0)));
  EXPECT_EQ(hold.moved(), Vec3(0.0));
  EXPECT_FALSE(hold.follow(true, Vec3(1.0, 2.0, 3.0)));
  EXPECT_EQ(hold.moved(), Vec3(0.0)) << "nothing moves by being taken";
  EXPECT_FALSE(hold.follow(true, Vec3(1.0, 6.0, 3.0)));
  EXPECT_EQ(hold.moved(), Vec3(0.0, -4.0, 0.0))
      << "the view goes the other way, so that the scene goes along";
  // Let go somewhere else: the view stays as it was last seen.
  const auto left = hold.follow(false, Vec3(9.0, 9.0, 9.0));
  ASSERT_TRUE(left);
  EXPECT_EQ(*left, Vec3(0.0, -4.0, 0.0));
  EXPECT_EQ(hold.moved(), Vec3(0.0));
  EXPECT_FALSE(hold.follow(false, Vec3(0.0))) << "told once";
}

}  // namespace
}  // namespace palpate::test
