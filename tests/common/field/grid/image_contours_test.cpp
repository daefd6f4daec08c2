#include "common/field/grid/image_contours.h"

#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

namespace palpate {
namespace {

/// A layer of n x n points over [-1, 1]^2, turned and moved in space.
UniformTopology layer(int n) {
  UniformTopology lattice;
  const double h = 2.0 / (n - 1);
  const Vec3 u = glm::normalize(Vec3(1.0, 2.0, 2.0)), v = glm::normalize(Vec3(2.0, 1.0, -2.0));
  lattice.points = {n, n, 1};
  lattice.axes = Mat3(h * u, h * v, glm::cross(u, v));
  lattice.origin = Vec3(5.0, -3.0, 1.0) - u - v;
  return lattice;
}

/// x, y of a place of the layer.
Vec2 on_layer(const UniformTopology& lattice, const Vec3& x) {
  return Vec2(glm::inverse(lattice.axes) * (x - lattice.origin)) * (2.0 / (lattice.points.x - 1)) - 1.0;
}

std::vector<float> sampled(int n, const std::function<double(const Vec2&)>& formula) {
  std::vector<float> values;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i)
      values.push_back(static_cast<float>(formula(Vec2(i, j) * (2.0 / (n - 1)) - 1.0)));
  }
  return values;
}

double worst_radius_error(int n, double radius) {
  const UniformTopology lattice = layer(n);
  const auto lines = contour_lines(lattice, sampled(n, [](const Vec2& x) { return glm::length(x); }), radius);
  EXPECT_EQ(lines.size(), 1U);
  double worst = 0.0;
  for (const ContourPoint& point : lines.front()) {
    const double off = std::abs(glm::length(on_layer(lattice, point.position)) - radius);
    EXPECT_LE(off, 1.5 * point.error) << "where the error is stated as " << point.error;
    worst = std::max(worst, off);
  }
  EXPECT_EQ(lines.front().front().position, lines.front().back().position);
  return worst;
}

// The section of a ball's distance field is a circle; linear interpolation is of order two.
TEST(ContourLines, ACircleOfADistanceFieldConvergesWithOrderTwoWithinItsStatedError) {
  const double coarse = worst_radius_error(33, 0.61), fine = worst_radius_error(129, 0.61);
  EXPECT_NEAR(0.5 * std::log2(coarse / fine), 2.0, 0.25);
}

// Bilinear values are linear along edges: places on them are exact, to the rounding of the samples.
TEST(ContourLines, PlacesAreExactWhereValuesAreBilinear) {
  const int n = 20;
  const UniformTopology lattice = layer(n);
  const auto formula = [](const Vec2& x) { return 0.3 + x.x - 0.5 * x.y + 0.7 * x.x * x.y; };
  const auto lines = contour_lines(lattice, sampled(n, formula), 0.42);
  ASSERT_FALSE(lines.empty());
  for (const auto& line : lines) {
    for (const ContourPoint& point : line) {
      EXPECT_NEAR(formula(on_layer(lattice, point.position)), 0.42, 2e-7);
      EXPECT_GT(point.error, 0.0);
      EXPECT_LT(point.error, 2e-6);
    }
  }
}

// x y about its saddle: one value parts the two other corners than its opposite does.
TEST(ContourLines, TheSaddleOfASquareDecides) {
  UniformTopology lattice = layer(2);
  for (const double value : {0.2, -0.2}) {
    const auto lines = contour_lines(lattice, sampled(2, [](const Vec2& x) { return x.x * x.y; }), value);
    ASSERT_EQ(lines.size(), 2U);
    for (const auto& line : lines) {
      ASSERT_EQ(line.size(), 2U);
      const Vec2 a = on_layer(lattice, line[0].position), b = on_layer(lattice, line[1].position);
      const Vec2 middle = 0.5 * (a + b);
      EXPECT_GT(middle.x * middle.y * value, 0.0) << "on the side of the value's own corners";
    }
  }
}

TEST(ContourLines, EndAtTheBorderAndAtPointsWithoutAValue) {
  const int n = 11;
  const UniformTopology lattice = layer(n);
  std::vector<float> values = sampled(n, [](const Vec2& x) { return x.x; });
  EXPECT_EQ(contour_lines(lattice, values, 0.1).size(), 1U);
  values[static_cast<std::size_t>(5 * n + 5)] = std::numeric_limits<float>::quiet_NaN();
  const auto lines = contour_lines(lattice, values, 0.1);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].size() + lines[1].size(), static_cast<std::size_t>(n - 1));
  EXPECT_TRUE(contour_lines(lattice, values, 3.0).empty());
}

}  // namespace
}  // namespace palpate
