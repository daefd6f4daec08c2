/// Registration of two instruments through points that both know, by total least squares.
///
/// One instrument gives poses (p_i, q_i), the other sees points v_ij that are fixed at unknown places r_j in
/// the moving frame:
///   v_ij = p_0 + R(q_0) (p_i + R(q_i) r_j) (1)
/// Unknown are p_0, q_0, every r_j, and the true poses, of which only noisy readings are known: all residuals
/// are divided by their standard deviations, and the poses' readings are residuals too (Ikits 2006,
/// eqs. 4.11-4.14, sec. 4.2.4). With several markers it is the registration of an optical instrument to a
/// tracker; with one, the coregistration of arm and tracker with its nine parameters (sec. 4.4).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/calibration/fit_report.h"
#include "common/calibration/measurements.h"
#include "common/math/quaternion.h"

namespace palpate {

/// Standard deviations of the measurements, an axis.
struct RegistrationNoise {
  double pose_position = 1e-3;     ///< [m]
  double pose_orientation = 5e-3;  ///< [rad]
  double marker = 0.15e-3;         ///< [m]
};

struct RegistrationOptions {
  RegistrationNoise noise;
  Loss loss = Loss::kSquare;
  std::size_t folds = 5;
};

struct Registration {
  Rigid instrument_from_pose;  ///< p_0, q_0
  std::vector<Vec3> markers;   ///< r_j [m]; all that were seen, from the first
  std::vector<bool> seen;      ///< whether the measurements say anything about that marker
  FitReport report;
};

/// What a registration is called in reports, and what refusing one says.
enum class RegistrationKind { kApparatus, kCoregistration };

/// @throws Error (bad input) for fewer measurements than unknowns and for poses that do not turn about two
/// axes.
[[nodiscard]] Registration calibrate_registration(const MeasurementTable<MarkerMeasurement>& table,
                                                  RegistrationKind kind, const RegistrationOptions& options);

struct PointAlignment {
  Rigid to_from_from;  ///< measured = to_from_from * model
  double rms = 0.0;    ///< of the distances that remain [m]
  double width = 0.0;  ///< spread of the points across their longest direction; 0: they lie on a line [m]
};

/// The least-squares solution in closed form (Horn 1987; Arun, Huang and Blostein 1987): the minimum itself,
/// so nothing is iterated. Nothing for fewer than three points, or where they lie on a line.
[[nodiscard]] std::optional<PointAlignment> align_points(std::span<const Vec3> model,
                                                         std::span<const Vec3> measured);

}  // namespace palpate
