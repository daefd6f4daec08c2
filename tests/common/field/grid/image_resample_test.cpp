#include "common/field/grid/image_resample.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/grid/lattice_values.h"

namespace palpate {
namespace {

/// Oblique, left-handed, steps of 2, 2.5 and 3.
UniformTopology oblique() {
  const double c = std::cos(0.3), s = std::sin(0.3);
  return {{7, 5, 6},
          {10.0, -20.0, 5.5},
          Mat3(-2.0 * Vec3(c, s, 0.0), 2.5 * Vec3(-s, c, 0.0), Vec3(0.0, 0.0, 3.0))};
}

UniformTopology aligned() {
  return {{4, 5, 6}, {-3.0, 2.0, 8.0}, Mat3(Vec3(2.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.5), Vec3(0.0, -1.0, 0.0))};
}

/// Values of a function at the points of a lattice.
template <typename F>
DataArray values_on(const UniformTopology& grid, const F& f) {
  std::vector<double> values;
  for (int z = 0; z < grid.points.z; ++z) {
    for (int y = 0; y < grid.points.y; ++y) {
      for (int x = 0; x < grid.points.x; ++x) values.push_back(f(grid.origin + grid.axes * Vec3(x, y, z)));
    }
  }
  return make_array("s", Association::kPoint, 1, values);
}

Vec3 position(const UniformTopology& lattice, std::size_t index) {
  const auto i = static_cast<int>(index) % lattice.points.x, j = static_cast<int>(index) / lattice.points.x;
  return lattice.origin + lattice.axes * Vec3(i, j, 0);
}

// Trilinear interpolation keeps functions that are linear along the axes: 1 + x - 2 y + 3 z.
TEST(Resample, IsExactOnLinearFunctionsAndKnowsWhereTheImageEnds) {
  const auto f = [](const Vec3& x) { return 1.0 + x.x - 2.0 * x.y + 3.0 * x.z; };
  const UniformTopology image = oblique();
  const DataArray values = values_on(image, f);
  const auto lattice = plane_lattice(image, {glm::normalize(Vec3(1.0, 2.0, -0.5)), -8.0}, 0.7);
  ASSERT_TRUE(lattice);
  const ResampledImage slice = resample(image, values, 0, *lattice, -1e6F, 2);
  const Mat3 grid_from_data = glm::inverse(image.axes);
  std::size_t outside = 0;
  for (std::size_t i = 0; i < slice.values.size(); ++i) {
    const Vec3 x = position(*lattice, i), g = grid_from_data * (x - image.origin);
    EXPECT_NEAR(glm::dot(glm::normalize(Vec3(1.0, 2.0, -0.5)), x), -8.0, 1e-12);
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis)
      inside = inside && g[axis] >= 0.0 && g[axis] <= image.points[axis] - 1;
    outside += inside ? 0 : 1;
    EXPECT_NEAR(slice.values[i], inside ? f(x) : -1e6, 1e-4) << i;
  }
  EXPECT_EQ(slice.outside, outside);
  EXPECT_GT(outside, 10U);
  EXPECT_LT(outside, slice.values.size() - 100);
}

// On planes of the image's own points a slice is the voxels themselves: their numbers, to the bit.
TEST(PlaneLattice, TakesTheVoxelsThemselvesWhereItCan) {
  const UniformTopology image = aligned();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const DataArray values = values_on(image, [&](const Vec3&) { return any(random); });
  // The plane y = 0 is the third layer along the image's last axis; x to the right, z up.
  const auto lattice = plane_lattice(image, {Vec3(0.0, -1.0, 0.0), 0.0}, std::nullopt);
  ASSERT_TRUE(lattice);
  EXPECT_EQ(lattice->points, Index3(4, 5, 1));
  EXPECT_EQ(lattice->origin, Vec3(-3.0, 0.0, 8.0));
  EXPECT_EQ(lattice->axes[0], Vec3(2.0, 0.0, 0.0));
  EXPECT_EQ(lattice->axes[1], Vec3(0.0, 0.0, 0.5));
  const ResampledImage slice = resample(image, values, 0, *lattice, 0.0F, 1);
  EXPECT_EQ(slice.outside, 0U);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(slice.values[i], static_cast<float>(values.at(40 + i)));
  // The outermost layers count as inside, and so does what rounding puts a hair beyond.
  EXPECT_TRUE(plane_lattice(image, {Vec3(0.0, -1.0, 0.0), -2.0 - 1e-12}, std::nullopt));
  EXPECT_FALSE(plane_lattice(image, {Vec3(0.0, -1.0, 0.0), -2.1}, std::nullopt));
}

TEST(Resample, DoesNotDependOnThreadsAndHasNothingBesideMissingValues) {
  const UniformTopology image = aligned();
  std::vector<double> numbers(120, 1.0);
  numbers[0] = std::nan("");
  const DataArray values = make_array("s", Association::kPoint, 1, numbers);
  const auto lattice = plane_lattice(image, {glm::normalize(Vec3(1.0, 1.0, 1.0)), 6.0}, 0.1);
  ASSERT_TRUE(lattice);
  const ResampledImage one = resample(image, values, 0, *lattice, -7.0F, 1);
  const ResampledImage four = resample(image, values, 0, *lattice, -7.0F, 4);
  EXPECT_EQ(one.values, four.values);
  EXPECT_EQ(one.outside, four.outside);
  for (const float v : one.values) EXPECT_TRUE(v == 1.0F || v == -7.0F);
}

// Labels are those of the nearest voxel, with all their bits; a lattice on the voxels is known as such.
TEST(NearestPoints, TakeVoxelsAsTheyAre) {
  const UniformTopology image = aligned();
  std::vector<std::int64_t> wide(120);
  for (std::size_t i = 0; i < 120; ++i) wide[i] = (std::int64_t{1} << 60U) + static_cast<std::int64_t>(i);
  DataArray all;
  all.type = ScalarType::kInt64;
  all.tuples = 120;
  all.bytes = std::as_bytes(std::span(std::as_const(wide)));
  const std::int64_t none = -1;
  const auto beyond = std::as_bytes(std::span(&none, 1));
  const auto on = plane_lattice(image, {Vec3(0.0, -1.0, 0.0), 0.0}, std::nullopt);
  const NearestPoints there = nearest_points(image, *on);
  EXPECT_TRUE(there.exact);
  EXPECT_EQ(there.outside, 0U);
  const DataArray slice = values_at(all, there, beyond);
  ASSERT_EQ(slice.tuples, 20U);
  EXPECT_EQ(std::memcmp(slice.bytes.data(), wide.data() + 40, 160), 0);

  const auto oblique_plane = plane_lattice(image, {glm::normalize(Vec3(1.0, 2.0, 2.0)), 6.0}, 0.3);
  const NearestPoints some = nearest_points(image, *oblique_plane);
  EXPECT_FALSE(some.exact);
  EXPECT_GT(some.outside, 0U);
  const DataArray taken = values_at(all, some, beyond);
  const Mat3 grid_from_data = glm::inverse(image.axes);
  for (std::size_t i = 0; i < taken.tuples; ++i) {
    std::int64_t value = 0;
    std::memcpy(&value, taken.bytes.data() + 8 * i, 8);
    if (value == none) continue;
    const Vec3 g = glm::round(grid_from_data * (position(*oblique_plane, i) - image.origin));
    EXPECT_EQ(value, wide[static_cast<std::size_t>(g.x + 4 * (g.y + 5 * g.z))]);
  }
  // In double precision, and missing beside what is missing.
  std::vector<double> numbers(120, 1.0 / 3.0);
  numbers[0] = std::nan("");
  const DataArray values = make_array("s", Association::kPoint, 1, numbers);
  std::size_t missing = 0;
  for (const double value : values_on(image, values, 0, *oblique_plane, 1)) {
    missing += std::isnan(value) ? 1 : 0;
    if (!std::isnan(value)) {
      EXPECT_NEAR(value, 1.0 / 3.0, 1e-15);
    }
  }
  EXPECT_GE(missing, some.outside);
}

TEST(PointsIn, AreTheVoxelsOfABoxInTheirPlaces) {
  const UniformTopology image = aligned();
  Box box;
  box.include(Vec3(-1.0, 0.5, 8.4));
  box.include(Vec3(1.9, -9.0, 9.1));
  const auto part = points_in(image, box);
  ASSERT_TRUE(part);
  EXPECT_EQ(part->first, Index3(1, 1, 2));
  EXPECT_EQ(part->last, Index3(2, 2, 5));
  const UniformTopology lattice = part_of(image, *part);
  EXPECT_EQ(lattice.origin, Vec3(-1.0, 0.0, 8.5));
  EXPECT_EQ(lattice.points, Index3(2, 2, 4));
  EXPECT_EQ(lattice.axes, image.axes);
  Box beside;
  beside.include(Vec3(50.0));
  EXPECT_FALSE(points_in(image, beside));
}

// Power-of-two scales of space change no number: 2^-100 underflows where lengths are squared.
TEST(Resample, IsTheSameForScaledSpace) {
  const auto scaled = [](UniformTopology grid, double scale) {
    grid.origin *= scale;
    grid.axes *= scale;
    return grid;
  };
  const UniformTopology image = aligned();
  const DataArray values = values_on(image, [](const Vec3& x) { return x.x * x.y + x.z; });
  const double tiny = std::ldexp(1.0, -600);
  const ImagePlane plane{glm::normalize(Vec3(1.0, 2.0, 2.0)), 6.0};
  const auto lattice = plane_lattice(image, plane, std::nullopt);
  const auto small = plane_lattice(scaled(image, tiny), {plane.normal, plane.offset * tiny}, std::nullopt);
  ASSERT_TRUE(lattice && small);
  EXPECT_EQ(small->points, lattice->points);
  EXPECT_EQ(resample(scaled(image, tiny), values, 0, *small, 0.0F, 1).values,
            resample(image, values, 0, *lattice, 0.0F, 1).values);
}

// A part holds the bytes that the voxels have in the whole: wide numbers, NaN and colours stay what they are.
TEST(ValuesOf, APartKeepsTypeAndBits) {
  const UniformTopology image = aligned();
  const IndexBox part{{1, 0, 2}, {3, 3, 5}};
  const auto expect_kept = [&]<typename T>(std::vector<T> numbers, ScalarType type, int components) {
    DataArray all;
    all.type = type;
    all.components = components;
    all.tuples = numbers.size() / static_cast<std::size_t>(components);
    all.bytes = std::as_bytes(std::span(std::as_const(numbers)));
    const DataArray some = values_of(image, all, part);
    EXPECT_EQ(some.type, type);
    EXPECT_EQ(some.components, components);
    ASSERT_EQ(some.tuples, 3U * 4U * 4U);
    std::size_t to = 0;
    for (int z = 2; z <= 5; ++z) {
      for (int y = 0; y <= 3; ++y) {
        for (int x = 1; x <= 3; ++x, ++to) {
          const auto from = static_cast<std::size_t>(x + 4 * (y + 5 * z));
          const std::size_t size = sizeof(T) * static_cast<std::size_t>(components);
          EXPECT_EQ(std::memcmp(some.bytes.data() + to * size, all.bytes.data() + from * size, size), 0);
        }
      }
    }
  };
  std::vector<std::int64_t> wide(120);
  std::vector<double> real(120);
  std::vector<std::uint8_t> colors(360);
  for (std::size_t i = 0; i < 120; ++i) wide[i] = (std::int64_t{1} << 60U) + static_cast<std::int64_t>(i);
  for (std::size_t i = 0; i < 120; ++i)
    real[i] = i % 3 == 0 ? std::nan("") : 1.0 + 1e-15 * static_cast<double>(i);
  for (std::size_t i = 0; i < 360; ++i) colors[i] = static_cast<std::uint8_t>(7 * i);
  expect_kept(wide, ScalarType::kInt64, 1);
  expect_kept(real, ScalarType::kFloat64, 1);
  expect_kept(colors, ScalarType::kUint8, 3);
}

}  // namespace
}  // namespace palpate
