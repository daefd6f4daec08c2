/// Volumes from formulas, and transfer functions that show them.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstring>
#include <functional>
#include <memory>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "common/field/data_set.h"
#include "common/render/volume/volume_view.h"
#include "common/render/volume/voxels/volume_image.h"

namespace palpate::test {

/// A number for each point of a grid over [-1, 1]^3.
using Formula = std::function<double(const Vec3&)>;

/// Contrast on its way to the border of what a grid of 41 points can hold (Marschner and Lobb 1994).
inline double marschner_lobb(const Vec3& x) {
  constexpr double kFrequency = 6.0, kAlpha = 0.25;
  const double r = std::sqrt(x.x * x.x + x.y * x.y);
  const double rho = std::cos(2.0 * std::numbers::pi * kFrequency * std::cos(std::numbers::pi * r / 2.0));
  return (1.0 - std::sin(std::numbers::pi * x.z / 2.0) + kAlpha * (1.0 + rho)) / (2.0 * (1.0 + kAlpha));
}

/// Shells about the middle.
inline double shells(const Vec3& x) { return 0.5 + 0.5 * std::cos(9.0 * glm::length(x)); }

/// Blobs of different heights.
inline double blobs(const Vec3& x) {
  return 0.5 +
         0.5 * std::cos(6.0 * x.x) * std::cos(5.0 * x.y) * std::cos(4.0 * x.z) * std::exp(-glm::dot(x, x));
}

template <typename T>
DataSet block_of(const Index3& points, const Vec3& spacing, std::vector<T> numbers, ScalarType type) {
  auto storage = std::make_shared<std::vector<T>>(std::move(numbers));
  DataArray array;
  array.name = "s";
  array.type = type;
  array.tuples = storage->size();
  array.bytes = std::as_bytes(std::span<const T>(*storage));
  array.owner = storage;
  DataSet block;
  UniformTopology grid;
  grid.points = points;
  grid.axes = Mat3(spacing.x, 0.0, 0.0, 0.0, spacing.y, 0.0, 0.0, 0.0, spacing.z);
  grid.origin = -0.5 * (grid.axes * Vec3(points - 1));
  block.topology = grid;
  block.arrays.push_back(std::move(array));
  return block;
}

/// `formula` at points of a centred grid; values from 0 to 1 stand as 0 to the largest whole number.
inline DataSet sampled_block(const Index3& points, const Vec3& spacing, ScalarType type,
                             const Formula& formula) {
  std::vector<double> values;
  for (int k = 0; k < points.z; ++k) {
    for (int j = 0; j < points.y; ++j) {
      for (int i = 0; i < points.x; ++i) {
        const Vec3 place = Vec3(i, j, k) / glm::max(Vec3(points - 1), Vec3(1.0));
        values.push_back(formula(2.0 * place - 1.0));
      }
    }
  }
  const auto whole = [&]<typename T>(T, double largest) {
    std::vector<T> numbers;
    for (const double v : values) numbers.push_back(static_cast<T>(std::lround(v * largest)));
    return block_of(points, spacing, std::move(numbers), type);
  };
  if (type == ScalarType::kUint8) return whole(std::uint8_t{}, 255.0);
  if (type == ScalarType::kUint16) return whole(std::uint16_t{}, 65535.0);
  if (type == ScalarType::kInt8) return whole(std::int8_t{}, 127.0);
  if (type == ScalarType::kInt16) return whole(std::int16_t{}, 32767.0);
  return block_of(points, spacing, std::vector<float>(values.begin(), values.end()), ScalarType::kFloat32);
}

/// Over the values from `lower` to `upper`: clear below the middle, a faint layer, then opaque.
inline ColorTransfer layered(double lower, double upper) {
  return spread(ColorTransfer({{0.00, {0.0F, 0.0F, 1.0F}, 0.00},
                               {0.55, {0.0F, 0.5F, 1.0F}, 0.00},
                               {0.70, {1.0F, 0.3F, 0.0F}, 0.04},
                               {0.80, {0.0F, 1.0F, 0.0F}, 0.01},
                               {1.00, {1.0F, 1.0F, 1.0F}, 0.25}}),
                lower, upper);
}

inline VolumeView view_of(const DataSet& block) {
  VolumeView view;
  view.image = make_volume_image(block, "s", "test");
  view.transfer = layered(view.image->lowest, view.image->highest);
  view.shading = false;
  return view;
}

inline VolumeView sampled_view(const Formula& formula, ScalarType type = ScalarType::kFloat32,
                               int points = 33) {
  return view_of(sampled_block(Index3(points), Vec3(2.0 / (points - 1)), type, formula));
}

/// The same value everywhere in a box of 2 x 2 x 2, with an optical depth of `depth` a length of 1.
inline VolumeView even_view(double depth) {
  VolumeView view =
      view_of(sampled_block(Index3(5), Vec3(0.5), ScalarType::kFloat32, [](const Vec3&) { return 0.5; }));
  view.transfer = ColorTransfer({{0.0, {0.2F, 0.6F, 1.0F}, 1.0 - std::exp(-depth)}});
  view.opacity_length = 1.0;
  return view;
}

}  // namespace palpate::test
