#include "common/field/cells/hexahedron_difference.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/field/analytic/examples.h"
#include "tests/support/sample_meshes.h"
#include "tests/support/sampled.h"

namespace palpate {
namespace {

const VectorChoice kVelocity{VectorChoice::Kind::kArray, Association::kPoint, {"velocity"}, "velocity"};

HexahedronDifference difference_of(const DataSet& block) {
  const auto field = make_vector_field({block}, kVelocity, "test");
  return hexahedron_difference(*field, std::span(&block, 1));
}

/// One unit cube whose corner values come from `value`.
DataSet cube(Vec3 (*value)(const Vec3&)) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1, (i >> 1) & 1, i >> 2);
  return test::structured_block({2, 2, 2}, corners, value);
}

TEST(HexahedronDifference, LinearFieldsHaveNone) {
  const auto linear = [](const Vec3& x) { return Vec3{x.x - x.y, 2.0 * x.z, 1.0}; };
  const HexahedronDifference found = difference_of(test::mixed_cells(4, 0.1, 1, linear));
  EXPECT_GT(found.cells, 5U);
  EXPECT_LT(found.max, 1e-13);
}

// v = (x y, 0, 1) on five tetrahedra.
TEST(HexahedronDifference, OneCubeIsAsWorkedByHand) {
  const HexahedronDifference found = difference_of(cube([](const Vec3& x) {
    return Vec3{x.x * x.y, 0.0, 1.0};
  }));
  EXPECT_EQ(found.cells, 1U);
  // The linear interpolant on each tetrahedron, from its corners: corner tetrahedra at 100, 010, 001, 111 are
  // cut off where x - y - z > 0, y - x - z > 0, z - x - y > 0 and x + y + z > 2; the middle one is
  // (x + y - z) / 2 since it is 0, 1, 0, 0 at its corners.
  double expected = 0.0;
  for (const double x : {1.0 / 6, 0.5, 5.0 / 6}) {
    for (const double y : {1.0 / 6, 0.5, 5.0 / 6}) {
      for (const double z : {1.0 / 6, 0.5, 5.0 / 6}) {
        double linear = 0.5 * (x + y - z);          // middle
        if (x - y - z > 0.0) linear = y;            // 100 with 000, 110, 101: 0 but for 110
        if (y - x - z > 0.0) linear = x;            // 010
        if (z - x - y > 0.0) linear = 0.0;          // 001
        if (x + y + z > 2.0) linear = x + y - 1.0;  // 111 with 110, 101, 011
        expected = std::max(expected, std::abs(linear - x * y));
      }
    }
  }
  EXPECT_NEAR(found.max * std::sqrt(2.0), expected, 1e-14);  // the largest speed is sqrt 2
}

// Products of coordinates make the difference: the ABC flow, a sum of functions of one each, would not do.
TEST(HexahedronDifference, FallsWithTheSquareOfTheCellSize) {
  const auto formula = example("cavity");
  std::array<double, 2> rms{};
  for (std::size_t level = 0; level < 2; ++level) {
    const int n = level == 0 ? 17 : 33;
    rms[level] =
        difference_of(test::sample_curvilinear(*formula, {n, n, n}, 0.2, test::SampledType::kFloat64)).rms;
  }
  EXPECT_NEAR(std::log2(rms[0] / rms[1]), 2.0, 0.2);
}

TEST(HexahedronDifference, IsStatedForCurvilinearDataAndNotForBoxes) {
  const auto formula = example("abc");
  const auto states = [](const VectorField& field) {
    return std::any_of(field.notes().lines.begin(), field.notes().lines.end(), [](const std::string& line) {
      return line.find("trilinear hexahedra") != std::string::npos;
    });
  };
  EXPECT_TRUE(states(*make_vector_field({test::sample_curvilinear(*formula, {6, 6, 6})}, kVelocity, "test")));
  EXPECT_FALSE(states(*make_vector_field({test::sample_uniform(*formula, {6, 6, 6})}, kVelocity, "test")));
  EXPECT_FALSE(states(*make_vector_field({test::sample_tetrahedra(*formula, {6, 6, 6})}, kVelocity, "test")));
}

}  // namespace
}  // namespace palpate
