/// Lines along muscle fibres: on one layer of a heart's wall, or through the wall.
///
/// On a layer a line follows the direction in the layer (layer_fibre.h) by the classical Runge-Kutta method
/// of order four; every step is brought back to the layer's isosurface by the closest-point search that the
/// hand feels it with (isosurface.h), so each point lies on it to rounding (projection: Hairer, Lubich and
/// Wanner, Geometric Numerical Integration, sec. IV.4, keeps the order). Stages between are taken beside the
/// layer, where the direction goes on, and on it where the wall ends there. Through the wall it follows the
/// fibre as it is. Signs are chosen along the way.
///
/// Two steps of h are compared with one of 2h. Between kinks their distance over 15 would be the error of
/// both (Richardson; Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, sec. II.4), but
/// lines cross kinks at every cell: on a layer the facets of the isosurface turn what is left of the
/// direction, so that errors fall at first order in h, and the distance itself is the estimate; through the
/// wall the direction is continuous, and it is a third of the distance. They are summed up along the line. It
/// speaks of the method: what the mesh leaves out of the heart is not in it.
///
/// Lines end at the rim of the layer or the border of the mesh (left_domain, found by halving), where the
/// gap falls below the cut-off or the fibre stands on the layer (below_cutoff), where fibres are not known
/// (bad_data), at their length, and where they close on themselves within their error (loop).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/base/progress.h"
#include "common/geometry/line.h"
#include "common/trace/layer_fibre.h"
#include "common/trace/line_errors.h"

namespace palpate {

struct FibreLineOptions {
  std::optional<double> layer;  ///< depth s of the layer, 0 to 1; none: through the wall
  double step = 0.0;            ///< h, data units; 0: kFibreStep diagonals
  double max_length = 0.0;      ///< data units; 0: ten diagonals
  double least_gap = 0.05;      ///< below it the direction counts as undefined
  bool forward = true;
  bool backward = true;  ///< both: two lines a seed. Fibres have no sign: which is which has no meaning
  int threads = 0;       ///< 0: all cores; the lines do not depend on it
};

/// Default step in diagonals.
inline constexpr double kFibreStep = 1e-3;

struct FibreLineResult {
  std::vector<Line> lines;                   ///< by seed; `time` is the arc, signed, `speed` 1
  std::vector<std::uint32_t> outside_seeds;  ///< those from which no way leads to the layer, or outside
  std::array<std::size_t, kEndCount> ends{};
  std::size_t points = 0;
  LineErrors errors;
  double step = 0.0;        ///< as applied
  double max_length = 0.0;  ///< as applied
  double seconds = 0.0;
};

/// Traces from every seed (data coordinates), which first goes to the layer along the gradient of the depth.
/// @throws Error (usage) for a layer that the heart does not have or numbers that make no sense; Cancelled.
[[nodiscard]] FibreLineResult trace_fibres(const LayeredHeart& heart, std::span<const Vec3> seeds,
                                           const FibreLineOptions& options, Progress* progress = nullptr);

}  // namespace palpate
