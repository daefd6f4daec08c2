/// What single precision leaves open of the values of a field.
#pragma once

#include <span>
#include <variant>

#include "common/field/vector_field.h"

namespace palpate {

/// By which part of itself a value may be off that is held in single precision: half a unit in the last place from the file,
/// and as much again where values are brought to the points, or divided. Doubles: nothing that counts.
[[nodiscard]] inline double value_rounding(const PointVectors& values) noexcept {
  constexpr double kSingle = 0x1p-24;
  const auto* const singles = std::get_if<std::span<const float>>(&values.values);
  return singles != nullptr && !singles->empty() ? 2.0 * kSingle : 0.0;
}

}  // namespace palpate
