
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/render/probe_view.h"
#include "tests/support/path_view.h"

namespace palpate {
namespace {

TEST(ProbePath, KeepsPointsAndForcesInOrder) {
  ProbePath path;
  path.append({1.0, 0.0, 0.0}, 0.5);
  path.append({2.0, 0.0, 0.0}, 0.75);
  ASSERT_EQ(path.size(), 2U);
  EXPECT_EQ(path.positions()[1], Vec3(2.0, 0.0, 0.0));
  EXPECT_EQ(path.forces()[1], 0.75);
  ASSERT_EQ(path.pieces().size(), 1U);
  EXPECT_EQ(path.pieces()[0], 0U);
}

TEST(ProbePath, PositionsThatAreNotFinitePartIt) {
  ProbePath path;
  path.append({NAN, 0.0, 0.0}, 0.0);  // a gap before the first point
  path.append({1.0, 0.0, 0.0}, 0.0);
  path.append({2.0, 0.0, 0.0}, 0.0);
  path.append({HUGE_VAL, 0.0, 0.0}, 0.0);
  path.append({0.0, NAN, 0.0}, 0.0);
  path.append({2.0, 0.0, 0.0}, 0.0);  // the same place again: a new piece nevertheless
  ASSERT_EQ(path.size(), 3U);
  ASSERT_EQ(path.pieces().size(), 2U);
  EXPECT_EQ(path.pieces()[0], 0U);
  EXPECT_EQ(path.pieces()[1], 2U);
}

TEST(ProbePath, RestingHandAddsNothing) {
  ProbePath path(0.1);
  for (int i = 0; i < 1000; ++i) path.append({0.01 * (i % 2), 0.0, 0.0}, 1.0);
  EXPECT_EQ(path.size(), 1U);
  path.append({0.0, 0.11, 0.0}, 1.0);
  EXPECT_EQ(path.size(), 2U);

  ProbePath exact;  // without a spacing only repeats are left out, however small the data
  for (const double x : {0.0, 0.0, 1e-200, 1e-200}) exact.append({x, 0.0, 0.0}, 1.0);
  EXPECT_EQ(exact.size(), 2U);
}

TEST(ProbePath, IsMadeFromTheColumnsOfALog) {
  const std::array positions{Vec3(0.0), Vec3(1.0), Vec3(NAN), Vec3(2.0)};
  const std::array forces{0.0, 1.0, 2.0, 3.0};
  const PathView view = test::make_path_view(positions, forces);
  EXPECT_EQ(view.count, 3U);
  ASSERT_EQ(view.points->size(), 3U);
  EXPECT_EQ(view.points->forces()[2], 3.0);
  EXPECT_THROW((void)test::make_path_view(positions, std::array{1.0}), Error);
}

}  // namespace
}  // namespace palpate
