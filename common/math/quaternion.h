/// Unit quaternions and rigid motions, in double precision.
///
/// A rotation takes coordinates of one frame to another: `to_from_from * x_from`. Products read from right to
/// left.
#pragma once

#include <cmath>

#include <glm/gtc/quaternion.hpp>

#include "common/math/vec.h"

namespace palpate {

/// w + xi + yj + zk; GLM's constructor takes (w, x, y, z).
using Quat = glm::dquat;

inline constexpr double kDegree = 0.017453292519943295;  ///< [rad]

[[nodiscard]] inline Quat identity_rotation() noexcept { return {1.0, 0.0, 0.0, 0.0}; }

/// Rotation by |v| radians about v (the exponential map).
[[nodiscard]] inline Quat rotation_by(const Vec3& v) noexcept {
  const double half = 0.5 * glm::length(v);
  // sin(h) / (2 h) is 1/2 to rounding below that angle.
  constexpr double kSmall = 1e-8;
  const double factor = half < kSmall ? 0.5 : 0.5 * std::sin(half) / half;
  return {std::cos(half), factor * v.x, factor * v.y, factor * v.z};
}

/// Angle of the rotation `q`, in [0, pi] [rad].
[[nodiscard]] inline double angle_of(const Quat& q) noexcept {
  return 2.0 * std::atan2(glm::length(Vec3{q.x, q.y, q.z}), std::abs(q.w));
}

/// The rotation vector of `q`, no longer than pi [rad]: what rotation_by() turns into q or -q.
[[nodiscard]] inline Vec3 rotation_vector(const Quat& q) noexcept {
  const Vec3 v = q.w < 0.0 ? Vec3{-q.x, -q.y, -q.z} : Vec3{q.x, q.y, q.z};
  const double sine = glm::length(v);
  // 2 asin(s) / s is 2 to rounding below that sine.
  constexpr double kSmall = 1e-8;
  return sine < kSmall ? 2.0 * v : 2.0 * std::atan2(sine, std::abs(q.w)) / sine * v;
}

/// The vector part of the one of q and -q whose scalar part is not negative: sin(angle / 2) times the axis.
[[nodiscard]] inline Vec3 short_vector_part(const Quat& q) noexcept {
  return q.w < 0.0 ? Vec3{-q.x, -q.y, -q.z} : Vec3{q.x, q.y, q.z};
}

/// The unit quaternion with a vector part (Ikits 2006, eq. 4.5); a vector longer than 1 gives half a turn.
[[nodiscard]] inline Quat rotation_with_vector_part(const Vec3& v) noexcept {
  const double length2 = glm::dot(v, v);
  if (length2 < 1.0) return {std::sqrt(1.0 - length2), v.x, v.y, v.z};
  const Vec3 u = glm::normalize(v);
  return {0.0, u.x, u.y, u.z};
}

/// x_to = rotation * x_from + translation.
struct Rigid {
  Quat rotation{1.0, 0.0, 0.0, 0.0};
  Vec3 translation{0.0};

  [[nodiscard]] Vec3 operator*(const Vec3& x) const noexcept { return rotation * x + translation; }
  [[nodiscard]] Rigid operator*(const Rigid& next) const noexcept {
    return {rotation * next.rotation, rotation * next.translation + translation};
  }
  [[nodiscard]] Rigid inverse() const noexcept {
    const Quat back = glm::conjugate(rotation);
    return {back, -(back * translation)};
  }
};

}  // namespace palpate
