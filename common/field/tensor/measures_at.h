/// The measures of a field of tensors at a place, as tables and readouts show them.
#pragma once

#include <limits>

#include "common/field/tensor/diffusion_measures.h"
#include "common/field/tensor/tensor_field.h"

namespace palpate {

struct TensorMeasures {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  Anisotropy parts{kNone, kNone, kNone};
  double fractional_anisotropy = kNone;
};

/// NaN, all of them, where there is no tensor. @param x data coordinates. @rt Safe.
[[nodiscard]] TensorMeasures measures_at(const TensorField& field, const Vec3& x, CellHint& hint) noexcept;

}  // namespace palpate
