/// An orthonormal frame along a direction.
#pragma once

#include "common/math/vec.h"

namespace palpate {

/// The columns t, e_2, e_3, right-handed; which way e_2 points about the unit vector `t` has no meaning.
[[nodiscard]] inline Mat3 frame_along(const Vec3& t) noexcept {
  const Vec3 size = glm::abs(t);
  const Vec3 other = size.x <= size.y && size.x <= size.z ? Vec3{1.0, 0.0, 0.0}
                     : size.y <= size.z                   ? Vec3{0.0, 1.0, 0.0}
                                                          : Vec3{0.0, 0.0, 1.0};
  const Vec3 second = glm::normalize(glm::cross(t, other));
  return {t, second, glm::cross(t, second)};
}

}  // namespace palpate
