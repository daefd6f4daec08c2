/// How fast and how well a hand of delay and tremor places a cutting plane: by itself, on the haptic grid,
/// with and without landmarks, and with the plane widget, free and constrained (Ikits 2006, sec. 8.5
/// and 8.6).
///
/// The plane has to go from the middle of the workspace to a node of the grid 20 to 80 mm along its normal z.
/// The operator (hand_model.h) sees where it is and goes after what is missing at 2.5/s: with a reaction
/// delay of 0.2 s and a lag of 0.1 s the loop crosses over at 2.5 rad/s, as people's do in slow aiming
/// (McRuer & Jex 1967). A firm hand holds a simulated arm, on which the force of the chain acts. The plane is
/// placed once it has stayed within half a voxel for 0.3 s. Targets and tremor come from seeds: equal
/// settings give equal bits.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "lab/data/stability.h"
#include "lab/data/sweep.h"
#include "lab/page/section.h"

namespace palpate {

enum class PlacingMeans : std::uint8_t {
  kHandAlone,          ///< the plane's centre is where the hand is
  kGrid,               ///< on an axis of the grid, freely along it
  kGridDetents,        ///< from node to node
  kGridLandmark,       ///< with a landmark where the plane shall go
  kWidgetFree,         ///< the plane widget with constraints that let go at once
  kWidgetConstrained,  ///< with constraints that hold
};
inline constexpr int kPlacingMeansCount = 6;
[[nodiscard]] std::string name_of(PlacingMeans means);

struct PlacingSettings {
  double voxel = 0.0012;  ///< [m]
  double tremor = 3e-4;   ///< root of its mean square on each axis [m]: an arm that is not rested
  int trials = 24;
  std::uint64_t seed = 1;
};

struct PlacingTrial {
  bool placed = false;    ///< within 10 s
  double seconds = 0.0;   ///< until it has stayed
  double off = 0.0;       ///< along the normal, then [m]
  double sideways = 0.0;  ///< of its centre, across the normal [m]
};
[[nodiscard]] PlacingTrial place_plane(PlacingMeans means, const PlacingSettings& settings, int trial);

/// A median and the interval that covers the true one with 95 % probability whatever the distribution: from
/// one order statistic to another, the narrowest that are evenly far from the ends (binomial, p = 1/2). Minus
/// and plus infinity below six values.
struct MedianInterval {
  double median = 0.0, low = 0.0, high = 0.0;
};
/// @pre values is not empty.
[[nodiscard]] MedianInterval median_interval(std::vector<double> values);

struct PlacingRow {
  PlacingMeans means = PlacingMeans::kHandAlone;
  int trials = 0, placed = 0;
  /// [s] by which the hand alone takes longer to the same target, with the same tremor. What was never placed
  /// counts as the 10 s that it was given, on either side.
  MedianInterval gain;
  MedianInterval seconds;     ///< of those that were placed
  double seconds_p90 = 0.0;   ///< likewise
  MedianInterval off;         ///< [m]
  double off_p90 = 0.0;       ///< [m]
  double sideways_p90 = 0.0;  ///< [m]
};

/// One row for each means. @throws Cancelled.
[[nodiscard]] std::vector<PlacingRow> run_plane_placing(const PlacingSettings& settings, Progress* progress);

[[nodiscard]] ReportSection plane_placing_section(const std::vector<PlacingRow>& rows,
                                                  const PlacingSettings& settings);
/// That constraints keep what they constrain, whatever the hand does.
[[nodiscard]] std::vector<StabilityCase> plane_placing_cases(const std::vector<PlacingRow>& rows);

}  // namespace palpate
