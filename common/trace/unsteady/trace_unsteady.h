/// Pathlines, streaklines and timelines of a flow that changes in time.
///
/// The flow is known at steps of time. Between two of them it is interpolated (flow_in_time.h), and particles are
/// carried by it,
///
///   x'(t) = v(t, x(t)),                                                                        (1)
///
/// with the method of Dormand and Prince, whose steps end where the interpolation has its kinks. All particles
/// advance from step to step together, so that no more steps are in memory than one interval needs.
///
/// What the sampling in time costs is measured: the particles are carried once more through every second step
/// alone, and the distance between both is part of the error of each point. Where the steps resolve the flow it
/// falls with their square (linear) or faster, and the lines are better than it says.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "common/base/progress.h"
#include "common/field/vector_field.h"
#include "common/trace/trace.h"

namespace palpate {

enum class LineKind : std::uint8_t {
  kStreamlines,  ///< of one moment: trace.h
  kPathlines,    ///< where a particle goes
  kStreaklines,  ///< where the particles are that were released at one place
  kTimelines     ///< where the particles are that lay on one line: a material line
};
[[nodiscard]] std::string_view name_of(LineKind kind) noexcept;  ///< "pathlines"
/// @throws Error (usage) that lists the known ones.
[[nodiscard]] LineKind line_kind_from_name(std::string_view name);

enum class TimeOrder : std::uint8_t {
  kLinear,  ///< of the steps on both sides
  kCubic    ///< Hermite, with slopes from the steps beside these: four steps in memory
};
[[nodiscard]] std::string_view name_of(TimeOrder order) noexcept;  ///< "cubic"
/// @throws Error (usage) that lists the known ones.
[[nodiscard]] TimeOrder time_order_from_name(std::string_view name);

/// The flow at a step. May throw.
using StepReader = std::function<std::shared_ptr<const VectorField>(std::size_t step)>;

struct UnsteadyOptions {
  LineKind kind = LineKind::kPathlines;  ///< no streamlines
  TimeOrder order = TimeOrder::kLinear;
  double from = 0.0;  ///< the first release
  /// When the lines end or are seen; absent: at the last step (backward: at the first).
  std::optional<double> until;
  /// Between releases; 0: one release, of streaklines one each 1/64 of the time from `from` to `until`.
  double every = 0.0;
  /// One direction, no `step`, and dp54 or no integrator. A `max_time` is the age of a particle.
  TraceOptions trace;
};

/// What is to be known of lines in time besides themselves. Lengths in data units.
struct InTime {
  double from = 0.0, until = 0.0;   ///< as applied
  std::size_t releases = 0;         ///< of each seed
  std::size_t steps = 0;            ///< of the data, from the first to the last that was needed
  std::size_t steps_in_memory = 0;  ///< at once
  bool sampling_known = false;      ///< there were steps to be left out
  double sampling = 0.0;            ///< the largest distance of a particle that leaving out made
  double integration = 0.0;         ///< the largest error without it
  double gap = 0.0;                 ///< between neighbours on a streakline or a timeline
  bool moving_mesh = false;         ///< points move, and particles are looked for among moving cells
  bool other_meshes = false;  ///< cells change from step to step: each step is taken at the place itself
  std::size_t torn = 0;       ///< streaklines and timelines that are in pieces, since some particles ended
};

struct UnsteadyResult {
  TraceResult trace;
  InTime in_time;
};

/// Traces from every seed (data coordinates). Points of pathlines have the time since the release, those of the
/// other kinds the age of the particle there, and the arc is that along the line.
/// @param times of the steps, strictly rising. @param read gives the flow at them.
/// @throws Error (usage) where there are fewer than two steps, for times outside them, and for options that make no
/// sense together; Cancelled; what `read` throws.
[[nodiscard]] UnsteadyResult trace_unsteady(std::span<const double> times, const StepReader& read,
                                            std::span<const Vec3> seeds, const UnsteadyOptions& options,
                                            Progress* progress = nullptr);

}  // namespace palpate
