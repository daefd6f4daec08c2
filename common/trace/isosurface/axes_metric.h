/// Lengths and right angles in coordinates along axes that may be at no right angles.
///
/// Symbols.  B columns: unit vectors along the axes; x = B y in frame L; M = B^T B, the metric: |x|^2 = y^T M y.
///           A gradient along the axes is a covector: g . v is the rate along v.
/// Without a shear M is the identity, and every function gives the bits of the plain one.
#pragma once

#include <array>
#include <cmath>

#include "common/math/vec.h"

namespace palpate {

class AxesMetric {
 public:
  /// Right angles.
  AxesMetric() = default;
  /// @pre `axes` is B, invertible.
  explicit AxesMetric(const Mat3& axes) : sheared_(true), metric_(glm::transpose(axes) * axes) {
    for (unsigned free = 0; free < inverse_.size(); ++free) {
      // Fixed axes stand apart with ones, which the inverse keeps and which are taken out behind it.
      Mat3 part = metric_;
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
          if (!has(free, row) || !has(free, column)) part[column][row] = row == column ? 1.0 : 0.0;
        }
      }
      Mat3& inverse = inverse_[free];
      inverse = glm::inverse(part);
      for (int axis = 0; axis < 3; ++axis) {
        if (!has(free, axis)) inverse[axis][axis] = 0.0;
      }
    }
  }

  /// @name @rt Safe.
  /// @{
  [[nodiscard]] double dot(const Vec3& a, const Vec3& b) const noexcept { return glm::dot(a, lowered(b)); }
  [[nodiscard]] double length(const Vec3& v) const noexcept {
    return sheared_ ? std::sqrt(dot(v, v)) : glm::length(v);
  }
  [[nodiscard]] Vec3 unit(const Vec3& v) const noexcept {
    return sheared_ ? v / length(v) : glm::normalize(v);
  }
  /// M v.
  [[nodiscard]] Vec3 lowered(const Vec3& v) const noexcept { return sheared_ ? metric_ * v : v; }
  /// J M: what takes a direction to its coordinates takes the covector.
  [[nodiscard]] Mat3 lowered(const Mat3& jacobian) const noexcept {
    return sheared_ ? jacobian * metric_ : jacobian;
  }
  /// The direction along the axes in `free` (a bit each) in which g . v rises most, |direction|^2 = g . direction.
  [[nodiscard]] Vec3 raised(const Vec3& g, unsigned free) const noexcept {
    return sheared_ ? inverse_[free] * g : masked(g, free);
  }
  /// The nearest vector to `v` along the axes in `free`.
  [[nodiscard]] Vec3 projected(const Vec3& v, unsigned free) const noexcept {
    return sheared_ ? inverse_[free] * (metric_ * v) : masked(v, free);
  }
  /// The unit vector at right angles to two such ones, of either sense where sheared.
  [[nodiscard]] Vec3 across(const Vec3& a, const Vec3& b) const noexcept {
    return sheared_ ? unit(inverse_.back() * glm::cross(a, b)) : glm::cross(a, b);
  }
  /// @}

 private:
  [[nodiscard]] static bool has(unsigned free, int axis) noexcept {
    return ((free >> static_cast<unsigned>(axis)) & 1U) != 0;
  }
  [[nodiscard]] static Vec3 masked(const Vec3& v, unsigned free) noexcept {
    return {has(free, 0) ? v.x : 0.0, has(free, 1) ? v.y : 0.0, has(free, 2) ? v.z : 0.0};
  }

  bool sheared_ = false;
  Mat3 metric_{1.0};
  std::array<Mat3, 8> inverse_{};  ///< of M over the axes in the index, zero elsewhere
};

}  // namespace palpate
