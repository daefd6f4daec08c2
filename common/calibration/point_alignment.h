/// The rigid motion that brings points to where they were measured.
#pragma once

#include <optional>
#include <span>

#include "common/calibration/measurements.h"
#include "common/math/quaternion.h"

namespace palpate {

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
