/// Images of diffusion tensors whose tracts are known.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "common/field/tensor/tensor_field.h"
#include "common/math/vec.h"

namespace palpate::test {

/// A linear tensor along `direction`: eigenvalues 1.7, 0.3, 0.3 (1e-3 mm^2/s, as in white matter).
inline Mat3 tensor_along(const Vec3& direction) {
  const Vec3 e = glm::normalize(direction);
  return Mat3{0.3} + 1.4 * glm::outerProduct(e, e);
}

/// The image of `tensor`, a function of the place in data coordinates.
template <typename Number = float>
DataSet tensor_image(const UniformTopology& topology, const std::function<Mat3(const Vec3&)>& tensor) {
  std::vector<Number> values;
  for (int k = 0; k < topology.points.z; ++k) {
    for (int j = 0; j < topology.points.y; ++j) {
      for (int i = 0; i < topology.points.x; ++i) {
        const Mat3 d = tensor(topology.origin + topology.axes * Vec3(i, j, k));
        for (const double x : {d[0][0], d[1][0], d[2][0], d[1][1], d[2][1], d[2][2]}) {
          values.push_back(static_cast<Number>(x));
        }
      }
    }
  }
  DataSet image;
  image.topology = topology;
  image.arrays.push_back(make_array("D", Association::kPoint, 6, std::span<const Number>(values)));
  return image;
}

template <typename Number = float>
std::shared_ptr<const TensorField> tensor_field(
    const UniformTopology& topology, const std::function<Mat3(const Vec3&)>& tensor,
    TensorInterpolation interpolation = TensorInterpolation::kComponents) {
  return make_tensor_field(tensor_image<Number>(topology, tensor),
                           {.array = "D", .order = TensorOrder::kRows, .interpolation = interpolation},
                           "image");
}

/// Every field line is a helix about the z axis that climbs `pitch` a turn: at radius r the direction is
/// (-y, x, pitch / 2 pi).
struct Helices {
  double pitch = 10.0;

  [[nodiscard]] Vec3 direction(const Vec3& x) const { return {-x.y, x.x, pitch / (2.0 * M_PI)}; }
  /// Where the helix through (radius, 0, z0) has climbed by `climb`.
  [[nodiscard]] Vec3 at(double radius, double z0, double climb) const {
    const double angle = 2.0 * M_PI * climb / pitch;
    return {radius * std::cos(angle), radius * std::sin(angle), z0 + climb};
  }
};

}  // namespace palpate::test
