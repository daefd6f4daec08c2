#include "common/field/tensor/tensor_field.h"

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/math/symmetric3.h"
#include "tests/support/allocation_guard.h"

namespace palpate {
namespace {

constexpr Index3 kPoints{4, 5, 6};

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }

/// Positive, and linear in x: every interpolant of the components is exact.
Mat3 linear_tensor(const Vec3& x) {
  return Mat3{Vec3{9.0, 1.0, -0.5}, Vec3{1.0, 8.0, 0.25}, Vec3{-0.5, 0.25, 7.0}} +
         x.x * Mat3{Vec3{0.3, 0.1, 0.0}, Vec3{0.1, -0.2, 0.05}, Vec3{0.0, 0.05, 0.1}} +
         x.y * Mat3{Vec3{-0.1, 0.0, 0.2}, Vec3{0.0, 0.2, 0.1}, Vec3{0.2, 0.1, 0.15}} +
         x.z * Mat3{Vec3{0.05, 0.02, 0.01}, Vec3{0.02, 0.1, -0.1}, Vec3{0.01, -0.1, -0.2}};
}

Mat3 quarter_turned(double angle) {
  return {Vec3{std::cos(angle), std::sin(angle), 0.0}, Vec3{-std::sin(angle), std::cos(angle), 0.0},
          Vec3{0.0, 0.0, 1.0}};
}

UniformTopology plain_topology() { return {kPoints, Vec3{-1.0, 0.5, 2.0}, Mat3{0.5}}; }

/// Numbers of `tensor` in `order`, seven with a mask of one.
std::vector<double> tuple_of(const Mat3& d, TensorOrder order) {
  const double xx = d[0][0], xy = d[1][0], xz = d[2][0], yy = d[1][1], yz = d[2][1], zz = d[2][2];
  switch (order) {
    case TensorOrder::kRows:
      return {xx, xy, xz, yy, yz, zz};
    case TensorOrder::kMask:
      return {1.0, xx, xy, xz, yy, yz, zz};
    case TensorOrder::kDiagonal:
      return {xx, yy, zz, xy, xz, yz};
    case TensorOrder::kLower:
      return {xx, xy, yy, xz, yz, zz};
    case TensorOrder::kFull:
      return {xx, xy + 1.0, xz, xy - 1.0, yy, yz, xz, yz, zz};
    case TensorOrder::kAxis:  // has no tensor of its own: fibre_axes_test
      break;
  }
  return {};
}

template <typename Tensor>
DataSet image_of(const UniformTopology& topology, const Tensor& tensor,
                 TensorOrder order = TensorOrder::kRows, double scale = 1.0) {
  std::vector<double> values;
  for (int k = 0; k < topology.points.z; ++k) {
    for (int j = 0; j < topology.points.y; ++j) {
      for (int i = 0; i < topology.points.x; ++i) {
        const Vec3 x = topology.origin + topology.axes * Vec3(i, j, k);
        for (const double v : tuple_of(tensor(x), order)) values.push_back(v * scale);
      }
    }
  }
  DataSet image;
  image.topology = topology;
  image.arrays.push_back(
      make_array("D", Association::kPoint, component_count(order), std::span<const double>(values)));
  return image;
}

double largest_difference(const Mat3& a, const Mat3& b) {
  double most = 0.0;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) most = std::max(most, std::abs(a[c][r] - b[c][r]));
  }
  return most;
}

Vec3 point_in(const UniformTopology& topology, std::mt19937_64& random) {
  const Vec3 last(topology.points - Index3{1});
  return topology.origin +
         topology.axes * (last * Vec3{unit(random), unit(random), unit(random)} * 0.998 + 0.001);
}

TEST(TensorField, ComponentsOfALinearFieldAreExactOnEveryGrid) {
  const Mat3 shear{Vec3{0.5, 0.0, 0.0}, Vec3{0.2, 0.5, 0.0}, Vec3{0.0, 0.1, 0.5}};
  for (const Mat3& axes : {Mat3{0.5}, quarter_turned(0.4) * 0.5, shear, Mat3{-0.5}}) {
    UniformTopology topology = plain_topology();
    topology.axes = axes;
    const auto field = make_tensor_field(image_of(topology, linear_tensor), {.array = "D"}, "made");
    std::mt19937_64 random(1);
    CellHint hint;
    for (int i = 0; i < 300; ++i) {
      const Vec3 x = point_in(topology, random);
      const TensorSample sample = field->sample(x, hint);
      ASSERT_EQ(sample.status, SampleStatus::kOk);
      EXPECT_LT(largest_difference(sample.value, linear_tensor(x)), 1e-12);
    }
    EXPECT_EQ(field->sample(topology.origin + Vec3{100.0}, hint).status, SampleStatus::kOutside);
  }
}

TEST(TensorField, EveryOrderOfTheNumbersMeansTheSame) {
  const UniformTopology topology = plain_topology();
  std::mt19937_64 random(2);
  const Vec3 x = point_in(topology, random);
  for (const auto order : {TensorOrder::kRows, TensorOrder::kMask, TensorOrder::kDiagonal,
                           TensorOrder::kLower, TensorOrder::kFull}) {
    const auto field =
        make_tensor_field(image_of(topology, linear_tensor, order), {.array = "D", .order = order}, "made");
    CellHint hint;
    EXPECT_LT(largest_difference(field->sample(x, hint).value, linear_tensor(x)), 1e-12)
        << static_cast<int>(order);
  }
}

// Between two tensors with the same axes, each eigenvalue is a geometric mean.
TEST(TensorField, LogarithmsInterpolateGeometrically) {
  const UniformTopology topology = plain_topology();
  const Mat3 axes = quarter_turned(0.7);
  const auto tensor = [&](const Vec3& x) {
    return axes * Mat3{Vec3{std::exp(x.x), 0, 0}, Vec3{0, std::exp(-x.y), 0}, Vec3{0, 0, 2.0}} *
           glm::transpose(axes);
  };
  const auto field =
      make_tensor_field(image_of(topology, tensor),
                        {.array = "D", .interpolation = TensorInterpolation::kLogEuclidean}, "made");
  std::mt19937_64 random(4);
  CellHint hint;
  for (int i = 0; i < 50; ++i) {
    const Vec3 x = point_in(topology, random);
    EXPECT_LT(largest_difference(field->sample(x, hint).value, tensor(x)), 1e-12);
  }
}

// Between equal tensors that are turned against each other, the logarithm of the determinant is interpolated
// linearly, that is, not at all (Arsigny et al. 2006); a mean of components swells.
TEST(TensorField, LogarithmsDoNotSwellAndComponentsDo) {
  const UniformTopology topology = plain_topology();
  const auto tensor = [&](const Vec3& x) {
    const Mat3 axes = quarter_turned(1.3 * std::sin(2.0 * x.x + x.y - 0.7 * x.z));
    return axes * Mat3{Vec3{1.7, 0, 0}, Vec3{0, 0.4, 0}, Vec3{0, 0, 0.2}} * glm::transpose(axes);
  };
  const DataSet image = image_of(topology, tensor);
  const auto plain = make_tensor_field(image, {.array = "D"}, "made");
  const auto logs =
      make_tensor_field(image, {.array = "D", .interpolation = TensorInterpolation::kLogEuclidean}, "made");
  constexpr double kDeterminant = 1.7 * 0.4 * 0.2;
  std::mt19937_64 random(5);
  CellHint hint;
  double swollen = 0.0;
  for (int i = 0; i < 100; ++i) {
    const Vec3 x = point_in(topology, random);
    EXPECT_NEAR(glm::determinant(logs->sample(x, hint).value), kDeterminant, 1e-12);
    const double determinant = glm::determinant(plain->sample(x, hint).value);
    EXPECT_GT(determinant, (1.0 - 1e-12) * kDeterminant);
    swollen = std::max(swollen, determinant / kDeterminant);
  }
  EXPECT_GT(swollen, 1.3);
}

TEST(TensorField, LogarithmsKeepTensorsPositiveWhereFitsAreNot) {
  const UniformTopology topology = plain_topology();
  const auto tensor = [](const Vec3& x) {
    return Mat3{Vec3{1, 0, 0}, Vec3{0, 0.5, 0}, Vec3{0, 0, x.x > 0.0 ? -0.01 : 0.2}};
  };
  const DataSet image = image_of(topology, tensor);
  const auto plain = make_tensor_field(image, {.array = "D"}, "made");
  const auto logs =
      make_tensor_field(image, {.array = "D", .interpolation = TensorInterpolation::kLogEuclidean}, "made");
  EXPECT_EQ(plain->negative_tensors(), static_cast<std::size_t>(kPoints.y * kPoints.z));
  CellHint hint;
  const Vec3 x{0.4999, 1.0, 3.0};  // nearly on the points that have the negative ones
  EXPECT_LT(symmetric_eigenvalues(plain->sample(x, hint).value)[2], 0.0);
  EXPECT_GT(symmetric_eigenvalues(logs->sample(x, hint).value)[2], 0.0);
}

TEST(TensorField, MaskedAndBadPointsAreNoTensors) {
  const UniformTopology topology = plain_topology();
  DataSet image = image_of(topology, linear_tensor, TensorOrder::kMask);
  std::vector<double> values;
  for (std::size_t t = 0; t < image.arrays[0].tuples; ++t) {
    for (int c = 0; c < 7; ++c) values.push_back(image.arrays[0].at(t, c));
  }
  values[0] = 0.0;                                           // the first point is masked
  values.back() = std::numeric_limits<double>::quiet_NaN();  // the last one is bad
  image.arrays[0] = make_array("D", Association::kPoint, 7, std::span<const double>(values));
  const auto field = make_tensor_field(image, {.array = "D", .order = TensorOrder::kMask}, "made");
  CellHint hint;
  EXPECT_EQ(field->sample(topology.origin + Vec3{0.1}, hint).status, SampleStatus::kBadData);
  EXPECT_EQ(field->sample(topology.origin + Vec3{0.6}, hint).status, SampleStatus::kOk);
  EXPECT_EQ(field->notes().bad_values, 2U);
}

TEST(TensorField, ScaledByPowersOfTwoItHasTheSameBits) {
  const UniformTopology topology = plain_topology();
  UniformTopology large = topology;
  large.origin *= 0x1p60;
  large.axes *= 0x1p60;
  const auto near = [](const Vec3& x) { return linear_tensor(x); };
  const auto far = [](const Vec3& x) { return linear_tensor(x * 0x1p-60); };
  const auto a = make_tensor_field(image_of(topology, near), {.array = "D"}, "made");
  const auto b = make_tensor_field(image_of(large, far, TensorOrder::kRows, 0x1p-40), {.array = "D"}, "made");
  std::mt19937_64 random(5);
  CellHint hint;
  for (int i = 0; i < 100; ++i) {
    const Vec3 x = point_in(topology, random);
    EXPECT_EQ(a->sample(x, hint).value * 0x1p-40, b->sample(x * 0x1p60, hint).value);
  }
}

TEST(TensorField, SamplesWithoutAllocating) {
  const auto field =
      make_tensor_field(image_of(plain_topology(), linear_tensor),
                        {.array = "D", .interpolation = TensorInterpolation::kLogEuclidean}, "made");
  CellHint hint;
  const test::AllocationGuard guard;
  const TensorSample sample = field->sample({0.0, 1.0, 3.0}, hint);
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_EQ(sample.status, SampleStatus::kOk);
}

TEST(TensorField, WrongArraysAreRefusedByName) {
  const DataSet image = image_of(plain_topology(), linear_tensor);
  for (const TensorChoice& choice :
       {TensorChoice{.array = "E"}, TensorChoice{.array = "D", .order = TensorOrder::kFull}}) {
    try {
      static_cast<void>(make_tensor_field(image, choice, "made.nrrd"));
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      EXPECT_NE(std::string(error.what()).find("made.nrrd"), std::string::npos);
      EXPECT_NE(std::string(error.what()).find("'" + choice.array + "'"), std::string::npos);
    }
  }
}

TEST(TensorField, GivesTheTensorOfEachVoxelAloneWhateverTheOrderOfItsPoints) {
  const Mat3 sheared{Vec3{1.0, 0.0, 0.0}, Vec3{0.4, 1.0, 0.0}, Vec3{0.0, 0.3, -2.0}};
  for (const Mat3& axes : {Mat3{0.5}, Mat3{-0.5}, 0.5 * quarter_turned(0.3), sheared}) {
    const UniformTopology topology{kPoints, Vec3{-1.0, 0.5, 2.0}, axes};
    const auto field = make_tensor_field(image_of(topology, linear_tensor), {.array = "D"}, "test");
    ASSERT_TRUE(field->voxels());
    EXPECT_EQ(field->voxels()->points, kPoints);
    for (int i = 0; i < kPoints.x * kPoints.y * kPoints.z; ++i) {
      const Index3 at{i % kPoints.x, i / kPoints.x % kPoints.y, i / kPoints.x / kPoints.y};
      const TensorSample voxel = field->voxel(at);
      ASSERT_EQ(voxel.status, SampleStatus::kOk);
      EXPECT_LT(largest_difference(voxel.value, linear_tensor(topology.origin + topology.axes * Vec3(at))),
                1e-12);
    }
    EXPECT_EQ(field->voxel({-1, 0, 0}).status, SampleStatus::kOutside);
    EXPECT_EQ(field->voxel({0, kPoints.y, 0}).status, SampleStatus::kOutside);
  }
}

}  // namespace
}  // namespace palpate
