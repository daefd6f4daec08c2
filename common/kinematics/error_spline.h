/// Errors interpolated from measurements at scattered places, smoothly and with noise averaged out.
///
/// The biharmonic spline of three dimensions,
///   e(p) = sum_i w_i |p - p_i| + c_0 + C p,
/// has the least bending of all fields that pass as close to the measurements (Duchon 1977). Its time grows
/// with their number; an ErrorTable sampled from it answers in constant time.
#pragma once

#include <array>
#include <vector>

#include "common/kinematics/error_table.h"

namespace palpate {

struct ErrorSpline {
  std::vector<Vec3> centers;         ///< p_i [m]; none: zero everywhere
  std::vector<PoseError> weights;    ///< w_i
  std::array<PoseError, 4> plane{};  ///< c_0 and the columns of C

  /// @rt Safe.
  [[nodiscard]] PoseError at(const Vec3& p) const noexcept;
};

}  // namespace palpate
