/// Tracts of a field of diffusion tensors: deterministic tensor lines, in parallel over the seeds. Through a field with
/// peaks (peak_field.h) they follow the one that is nearest to the way they come, and end as at a sharp turn where
/// there is none.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/base/progress.h"
#include "common/field/tensor/tensor_field.h"
#include "common/geometry/line.h"
#include "common/geometry/tractogram.h"
#include "common/trace/trace.h"
#include "common/trace/tract/tensor6.h"
#include "common/trace/tract/tract_region.h"

namespace palpate {

/// Which way lines go from their seed: along the main eigenvector whose longest part is positive, against it, or
/// both.
enum class TractSense : std::uint8_t { kBoth, kForward, kBackward };

/// Lengths in data units (mm). Zeros stand for what a *voxel* says, the shortest step of the grid.
struct TractOptions {
  /// euler and rk4 take one step from each output point to the next; dp54 controls its error.
  Integrator integrator = Integrator::kDp54;
  double tolerance = 1e-4;  ///< dp54: error in position per length
  double step = 0.0;        ///< between output points; 0: a quarter of a voxel
  TractMeasure measure = TractMeasure::kFa;
  double cutoff = 0.2;      ///< lines end where the measure falls below it
  double max_angle = 0.0;   ///< [degrees] between tangents at neighbouring points; 0: by `min_radius`
  double min_radius = 0.0;  ///< of curvature, read as the angle that a step then turns; 0: a voxel
  double min_length = 0.0;  ///< shorter lines are dropped
  double max_length = 0.0;  ///< 0: the diagonal of the field
  TractSense sense = TractSense::kBoth;
  bool every_peak =
      false;  ///< of a field with peaks: a line from each of the seed's voxel, not from the longest alone
  std::int64_t max_steps = 1'000'000;  ///< from point to point, to each side of a seed
  std::vector<TractRegion> include;    ///< lines that miss one of them are dropped
  std::vector<TractRegion> exclude;    ///< lines that enter one of them are dropped
  /// Lines end where they enter one of them, that point included; one that holds the seed counts only after
  /// the line has left it.
  std::vector<TractRegion> stop;
  int threads = 0;  ///< 0: all cores; the lines do not depend on it
};

/// What became of seeds and lines that are not among the lines.
struct TractsDropped {
  std::size_t outside = 0;       ///< seeds outside the field
  std::size_t bad_data = 0;      ///< seeds where there is no tensor
  std::size_t below_cutoff = 0;  ///< seeds where the measure is too small
  std::size_t too_short = 0;     ///< lines
  std::size_t not_included = 0;  ///< lines
  std::size_t excluded = 0;      ///< lines
};

struct TractResult {
  /// By seed, a line each, or one for each of its peaks: from the end that lies against the main eigenvector at the seed, through the
  /// seed, to the other; of one way from the seed on. Points are `step` apart but for the first and the last. `error` of each point: the
  /// sum of the steps' error estimates from the seed on [mm], which says nothing of how the field spreads
  /// neighbouring lines.
  Tractogram lines;
  std::vector<std::uint32_t> seeds;  ///< of each line
  /// Of each line: of its first point, of its last. A seed that a line begins at is kStoppedByRule.
  std::vector<std::array<End, 2>> ends;
  std::array<std::size_t, kEndCount> end_counts{};
  TractsDropped dropped;
  double error_max = 0.0;  ///< data units
  /// What the zeros of the options stood for.
  double step = 0.0, max_angle = 0.0, max_length = 0.0;
  double seconds = 0.0;
};

/// @throws Error (usage) for numbers that make no sense.
void check_tract_options(const TractOptions& options);

/// Traces from every seed (data coordinates), to both sides.
/// Regions are tested at the points of the lines.
/// @throws Error (usage) for options that make no sense; Cancelled.
[[nodiscard]] TractResult trace_tracts(const TensorField& field, std::span<const Vec3> seeds,
                                       const TractOptions& options, Progress* progress = nullptr);

}  // namespace palpate
