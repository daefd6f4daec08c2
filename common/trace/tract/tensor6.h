/// A symmetric tensor as six numbers, and how much it prefers one direction: for the hot loop of tracing.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include "common/field/tensor/diffusion_measures.h"
#include "common/math/symmetric3.h"
#include "common/math/vec.h"

namespace palpate {

struct Tensor6 {
  double xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;

  [[nodiscard]] Vec3 operator*(const Vec3& v) const noexcept {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
  [[nodiscard]] double trace() const noexcept { return xx + yy + zz; }
  [[nodiscard]] Mat3 matrix() const noexcept {
    return {Vec3{xx, xy, xz}, Vec3{xy, yy, yz}, Vec3{xz, yz, zz}};
  }
};

/// What FA is made of: FA^2 = 3/2 |dev D|^2 / |D|^2 does not need
/// eigenvalues where none of them is below zero.
struct AnisotropyParts {
  bool positive = false;  ///< the tensor
  double deviator = 0.0;  ///< 3/2 |dev D|^2
  double all = 0.0;       ///< |D|^2
};

/// @rt Safe.
[[nodiscard]] inline AnisotropyParts anisotropy_parts(const Tensor6& d) noexcept {
  const double minor = d.xx * d.yy - d.xy * d.xy;
  const double determinant =
      d.zz * minor - d.xx * d.yz * d.yz - d.yy * d.xz * d.xz + 2.0 * d.xy * d.xz * d.yz;
  const double mean = d.trace() / 3.0;
  const double off = 2.0 * (d.xy * d.xy + d.xz * d.xz + d.yz * d.yz);
  const double x = d.xx - mean, y = d.yy - mean, z = d.zz - mean;
  return {.positive = d.xx > 0.0 && minor > 0.0 && determinant > 0.0,
          .deviator = 1.5 * (x * x + y * y + z * z + off),
          .all = d.xx * d.xx + d.yy * d.yy + d.zz * d.zz + off};
}

/// FA of a tensor; the same as fractional_anisotropy() of its eigenvalues. @rt Safe.
[[nodiscard]] inline double fractional_anisotropy(const Tensor6& d) noexcept {
  const AnisotropyParts parts = anisotropy_parts(d);
  if (!parts.positive) return fractional_anisotropy(symmetric_eigenvalues(d.matrix()));
  return std::sqrt(parts.deviator / parts.all);
}

/// What ends a tract where it falls below a cut-off.
enum class TractMeasure : std::uint8_t { kFa, kLinear };
[[nodiscard]] std::string_view name_of(TractMeasure measure) noexcept;  ///< "fa", "cl"
/// @throws Error (usage) that lists the known ones.
[[nodiscard]] TractMeasure tract_measure_from_name(std::string_view name);

/// In [0, 1]; NaN in gives NaN out. @rt Safe.
[[nodiscard]] inline double measure_of(TractMeasure measure, const Tensor6& d) noexcept {
  return measure == TractMeasure::kFa ? fractional_anisotropy(d)
                                      : anisotropy(symmetric_eigenvalues(d.matrix())).linear;
}

/// Whether the measure is `cutoff` or more; squares are compared where that will do. NaN is not. @rt Safe.
[[nodiscard]] inline bool reaches(TractMeasure measure, const Tensor6& d, double cutoff) noexcept {
  if (measure == TractMeasure::kFa) {
    const AnisotropyParts parts = anisotropy_parts(d);
    if (parts.positive) return parts.deviator >= cutoff * cutoff * parts.all;
  }
  return measure_of(measure, d) >= cutoff;
}

}  // namespace palpate
