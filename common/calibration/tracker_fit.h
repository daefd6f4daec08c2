/// Calibration of a tracker's distortion (Ikits 2006, sec. 4.2).
///
/// Minimized over calibration measurements, errors e as in tracker_correction.h (eqs. 4.9 and 4.10):
///   sum_i |e_i - f(p_t,i)|^2
/// for f a complete polynomial of degree r; a biharmonic spline of the scattered measurements, smoothed as
/// much as leaving one measurement out asks for; a trilinear table sampled from that spline; or a polynomial
/// with the table (or the spline) of what it leaves. Or f follows from a model of the metal that bends the field
/// (metal_fit.h), as a table of what that says, alone or with a spline of what it leaves.
#pragma once

#include <string>

#include "common/calibration/fit_report.h"
#include "common/calibration/measurements.h"

namespace palpate {

enum class TrackerMethod {
  kPolynomial,
  kTable,
  kSpline,
  kCombined,
  kCombinedSpline,
  kDipoles,
  kCombinedDipoles
};

[[nodiscard]] std::string name_of(TrackerMethod method);

struct TrackerFitOptions {
  TrackerMethod method = TrackerMethod::kCombined;
  int degree = 4;
  Loss loss =
      Loss::kSquare;      ///< of the polynomial; with any but kSquare spline and table leave gross errors out
  int table_nodes = 0;    ///< along the longest side; 0: as many as the measurements stand apart
  std::size_t folds = 5;  ///< of leave-out validation, where no measurements are marked for it
};

struct TrackerFit {
  TrackerCorrection correction;
  FitReport report;  ///< every method at the degree asked for, and the polynomials of all other degrees
};

/// The correction alone. @throws Error (bad input) as calibrate_tracker() does.
[[nodiscard]] TrackerCorrection fit_tracker(const std::vector<TrackerMeasurement>& rows,
                                            const TrackerFitOptions& options,
                                            const std::string& source = "measurements");

/// @throws Error (bad input) for fewer measurements than unknowns, and for places that do not fill a volume;
/// says what to measure, or which degree the measurements bear. So it does for poses in other units or another
/// convention, which it names, and (work failed) for a correction that leaves as much as there was before.
[[nodiscard]] TrackerFit calibrate_tracker(const MeasurementTable<TrackerMeasurement>& table,
                                           const TrackerFitOptions& options);

}  // namespace palpate
