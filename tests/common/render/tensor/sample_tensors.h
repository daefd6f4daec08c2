/// Images of tensors from formulas.
#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "common/field/tensor/tensor_field.h"
#include "common/render/tensor/tensor_view.h"

namespace palpate::test {

/// lambda_1 along `direction`, and the same across it. @pre a unit vector.
inline Mat3 linear_tensor(const Vec3& direction, double along = 1.7e-3, double across = 0.3e-3) {
  return Mat3(across) + (along - across) * glm::outerProduct(direction, direction);
}

/// `tensor(x)` at the voxels of `lattice`; NaN where there is none.
template <typename Tensor>
std::shared_ptr<const TensorVoxels> sampled_tensors(const UniformTopology& lattice, const Tensor& tensor) {
  std::vector<double> values;
  for (int k = 0; k < lattice.points.z; ++k) {
    for (int j = 0; j < lattice.points.y; ++j) {
      for (int i = 0; i < lattice.points.x; ++i) {
        const Mat3 d = tensor(lattice.origin + lattice.axes * Vec3(i, j, k));
        values.insert(values.end(), {d[0][0], d[1][0], d[2][0], d[1][1], d[2][1], d[2][2]});
      }
    }
  }
  DataSet block;
  block.topology = lattice;
  block.arrays.push_back(make_array("D", Association::kPoint, 6, std::span<const double>(values)));
  return make_tensor_voxels(make_tensor_field(block, {.array = "D"}, "test"), "test");
}

/// A lattice about the origin with the steps `axes`.
inline UniformTopology centred_lattice(const Index3& points, const Mat3& axes) {
  return {points, -0.5 * (axes * Vec3(points - 1)), axes};
}

/// A bundle that winds about the z axis once in a length of two, at the radius 0.55, in a ball of radius 1.3
/// of what diffuses alike in all directions; outside there are no tensors.
inline Mat3 helix_tensor(const Vec3& x) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  if (glm::length(x) > 1.3) return Mat3(nothing);
  constexpr double kRadius = 0.55, kWidth = 0.25, kPi = 3.14159265358979323846;
  const double angle = kPi * x.z;
  const Vec3 center{kRadius * std::cos(angle), kRadius * std::sin(angle), x.z};
  const Vec3 along = glm::normalize(Vec3(-kRadius * std::sin(angle), kRadius * std::cos(angle), 1.0 / kPi));
  const double share = std::exp(-glm::dot(x - center, x - center) / (kWidth * kWidth));
  return (1.0 - share) * Mat3(0.8e-3) + share * linear_tensor(along);
}

}  // namespace palpate::test
