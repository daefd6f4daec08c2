/// A traced line: points with time, arc length, speed and error, and why it ends. Data units.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "common/base/index.h"
#include "common/math/vec.h"

namespace palpate {

/// Why a line ends (the contract's `termination`).
enum class End : std::uint8_t {
  kLeftDomain,
  kStagnation,
  kMaxLength,
  kMaxTime,
  kMaxSteps,
  kLoop,
  kBadData,
  kStoppedByRule,
  kBelowCutoff,  ///< tracts: the measure of anisotropy fell below its cut-off
  kSharpTurn,    ///< tracts: it would have turned by more than allowed
  kEndOfTime,    ///< unsteady flow: the last moment that was asked for, or that there are data of
  kOpposedCells  ///< values constant over each cell: the flow on either side of a face points at it
};

inline constexpr int kEndCount = 12;

struct LinePoint {
  Vec3 position{0.0};
  double time = 0.0;   ///< from the seed on; falls when tracing backward
  double arc = 0.0;    ///< length along the curve from the seed, never falls
  double speed = 0.0;  ///< |v|
  double error = 0.0;  ///< accumulated estimate of the distance from the true curve of the interpolant; > 0
};

enum class TraceDirection : std::uint8_t { kForward, kBackward };

struct Line {
  std::vector<LinePoint> points;  ///< the seed first
  End end = End::kLeftDomain;
  TraceDirection direction = TraceDirection::kForward;
  std::uint32_t seed = 0;  ///< index into the seeds
  /// Of unsteady flow, in the data's time: when the particle of a pathline was released; when a streakline or a
  /// timeline is seen.
  double moment = 0.0;
};

/// "left_domain"
[[nodiscard]] inline std::string_view name_of(End end) noexcept {
  static constexpr std::array<std::string_view, kEndCount> kNames{
      "left_domain", "stagnation",      "max_length",   "max_time",   "max_steps",   "loop",
      "bad_data",    "stopped_by_rule", "below_cutoff", "sharp_turn", "end_of_time", "opposed_cells"};
  return kNames[as_size(end)];
}

}  // namespace palpate
