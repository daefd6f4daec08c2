/// Points fixed in a tracked frame: the tip of a stylus or the spot of a pinch, and the eyes in a head.
///
/// Pivot: the tip u rests in one place c while the sensor turns, p_i + R_i u = c for all i. Sighting: an eye
/// at e in the head's frame sees the near point a_i cover the far point b_i, so p_i + R_i e lies on the line
/// through both. Both are linear in the unknowns and are solved with a robust loss.
#pragma once

#include <optional>

#include "common/calibration/fit_report.h"
#include "common/calibration/measurements.h"

namespace palpate {

struct PointFitOptions {
  Loss loss = Loss::kSquare;
  double loss_scale = 2e-3;  ///< [m], beyond which a robust loss bends
  std::size_t folds = 5;
};

struct PivotFit {
  Vec3 tip{0.0};    ///< u in the sensor's frame [m]
  Vec3 pivot{0.0};  ///< c in the tracker's frame [m]
  FitReport report;
};

/// @throws Error (bad input) where the sensor turned about fewer than two axes.
[[nodiscard]] PivotFit calibrate_pivot(const MeasurementTable<PivotMeasurement>& table,
                                       const PointFitOptions& options);

struct EyeFit {
  std::optional<Vec3> left, right;  ///< in the head's frame [m]; those that there are sightings of
  /// Distance between the eyes [m]; with only one eye, none.
  std::optional<double> separation;
  FitReport report;
};

/// @throws Error (bad input) where an eye's sightings all run nearly parallel in the head's frame.
[[nodiscard]] EyeFit calibrate_eyes(const MeasurementTable<SightingMeasurement>& table,
                                    const PointFitOptions& options);

}  // namespace palpate
