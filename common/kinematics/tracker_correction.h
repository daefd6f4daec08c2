/// What a pose read from a distorted tracker is corrected to.
///
///   p = p_t + e_p(p_t),   q = q_e(p_t) q_t (1)
/// Ikits 2006, eqs. 4.1 and 4.4: the error quaternion q_e is expressed in the tracker's fixed frame, so it
/// depends on the place and not on how the sensor is turned; only its vector part is kept (eq. 4.6). The
/// error field is a polynomial, a table or a spline of scattered measurements, or a polynomial plus one of
/// them for what it leaves.
#pragma once

#include "common/kinematics/error_table.h"
#include "common/kinematics/vector_polynomial.h"
#include "common/math/quaternion.h"

namespace palpate {

/// A pose of a tracker's sensor in the tracker's frame R0.
struct TrackerPose {
  Vec3 position{0.0};  ///< [m]
  Quat orientation{1.0, 0.0, 0.0, 0.0};
};

/// Eqs. 4.1 and 4.3: what `reported` lacks to be `actual`.
[[nodiscard]] PoseError pose_error(const TrackerPose& actual, const TrackerPose& reported) noexcept;

struct TrackerCorrection {
  VectorPolynomial position, orientation;
  ErrorTable table;    ///< added to the polynomials
  ErrorSpline spline;  ///< likewise

  /// The error field at a reported position. @rt Safe.
  [[nodiscard]] PoseError error_at(const Vec3& reported) const noexcept;
  /// (1). @rt Safe.
  [[nodiscard]] TrackerPose corrected(const TrackerPose& reported) const noexcept;
};

}  // namespace palpate
