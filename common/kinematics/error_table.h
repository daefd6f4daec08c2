/// Errors at the nodes of a regular lattice, interpolated trilinearly: the lookup table of tracker
/// calibration.
#pragma once

#include <array>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

/// What a tracker's reading lacks at one place.
struct PoseError {
  Vec3 position{0.0};     ///< p_m - p_t [m] (Ikits 2006, eq. 4.1)
  Vec3 orientation{0.0};  ///< vector part of q_m q_t^* in the reference frame (eq. 4.3)
};

[[nodiscard]] inline PoseError operator+(const PoseError& a, const PoseError& b) noexcept {
  return {a.position + b.position, a.orientation + b.orientation};
}
[[nodiscard]] inline PoseError operator*(double s, const PoseError& e) noexcept {
  return {s * e.position, s * e.orientation};
}

struct ErrorTable {
  Vec3 lower{0.0};                ///< first node [m]
  Vec3 spacing{1.0};              ///< between nodes, > 0 [m]
  Index3 count{0};                ///< nodes an axis, >= 2 each; 0: an empty table, zero everywhere
  std::vector<PoseError> values;  ///< x fastest

  /// Outside the lattice the nearest border's value holds. @rt Safe.
  [[nodiscard]] PoseError at(const Vec3& p) const noexcept;
};

/// Errors interpolated from measurements at scattered places, smoothly and with noise averaged out.
///
/// The biharmonic spline of three dimensions,
///   e(p) = sum_i w_i |p - p_i| + c_0 + C p,
/// has the least bending of all fields that pass as close to the measurements (Duchon 1977). Its time grows
/// with their number; an ErrorTable sampled from it answers in constant time.
struct ErrorSpline {
  std::vector<Vec3> centers;         ///< p_i [m]; none: zero everywhere
  std::vector<PoseError> weights;    ///< w_i
  std::array<PoseError, 4> plane{};  ///< c_0 and the columns of C

  /// @rt Safe.
  [[nodiscard]] PoseError at(const Vec3& p) const noexcept;
};

}  // namespace palpate
