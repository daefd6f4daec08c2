/// The length by which normals of planes are divided.
#pragma once

#include <cmath>
#include <limits>

#include "common/math/vec.h"

namespace palpate {

/// |n|; 1 where that differs from it by rounding alone, so that a plane that was made unit once stays as it
/// is to the bit, however often it is written and read. @pre n is finite.
[[nodiscard]] inline double normal_length(const Vec3& n) noexcept {
  constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
  const double length = glm::length(n);
  return std::abs(length - 1.0) <= kRounding ? 1.0 : length;
}

}  // namespace palpate
