/// What a pose read from a distorted tracker is corrected to.
///
///   p = p_t + e_p(p_t),   q = q_e(p_t) q_t (1)
/// Ikits 2006, eqs. 4.1 and 4.4: the error quaternion q_e is expressed in the tracker's fixed frame, so it
/// depends on the place and not on how the sensor is turned; only its vector part is kept (eq. 4.6). The
/// error field is a polynomial, a table or a spline of scattered measurements, or a polynomial plus one of
/// them for what it leaves.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/math/quaternion.h"
#include "common/math/vec.h"

namespace palpate {

// Errors at the nodes of a regular lattice, interpolated trilinearly: the lookup table of tracker
// calibration.

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

// Complete vector polynomials of three variables.
//
//   f(p) = sum_j c_j x^{s_j} y^{t_j} z^{u_j},   0 <= s_j + t_j + u_j <= r (1) R = (r+1)(r+2)(r+3) / 6 terms
//   (2)
// Ikits 2006, eqs. 4.7 and 4.8. The variables are (p - center) / scale, so that powers stay near 1 and the
// fit is as well conditioned as the measurements allow; the printed form takes p itself.

inline constexpr int kMaxDegree = 8;  ///< 165 terms; real data carries no more
inline constexpr int kMaxTerms = (kMaxDegree + 1) * (kMaxDegree + 2) * (kMaxDegree + 3) / 6;

/// (2). @pre degree >= 0.
[[nodiscard]] constexpr int term_count(int degree) noexcept {
  return (degree + 1) * (degree + 2) * (degree + 3) / 6;
}

/// The monomials of (1) at `u`, x's power slowest. @pre values.size() == term_count(degree), degree in
/// [0, kMaxDegree]. @rt Safe.
void monomials(const Vec3& u, int degree, std::span<double> values) noexcept;

struct VectorPolynomial {
  int degree = -1;  ///< -1: zero everywhere
  Vec3 center{0.0};
  double scale = 1.0;
  std::vector<Vec3> coefficients;  ///< term_count(degree) of them, in the order of monomials()

  /// @rt Safe.
  [[nodiscard]] Vec3 at(const Vec3& p) const noexcept;
};

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
