#include "common/compose/lines_of_flow.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/compose/trace_options.h"
#include "common/scene/flow_series.h"

namespace palpate {
namespace {

/// Sentences about `reported`; lengths that matter are those of the diagonal.
void note(const InTime& reported, LineKind kind, double diagonal, std::vector<std::string>& notes) {
  if (reported.moving_mesh) notes.emplace_back("the mesh moves: values move with its cells");
  if (reported.other_meshes) {
    notes.emplace_back(
        "the cells change from step to step: each step is taken at the place itself, and lines end where the grid of "
        "either step does");
  }
  if (!reported.sampling_known) {
    notes.emplace_back(
        "the errors are those of the integration alone: between two steps of the data none can be left out to see "
        "what the sampling in time costs");
  } else if (reported.sampling > reported.integration) {
    notes.push_back(
        "the errors are those of the sampling in time: with every second step left out, particles go up to " +
        short_number(reported.sampling) +
        " elsewhere; more steps of the data lower that, where the flow is smooth --time-order cubic, too");
  }
  constexpr double kWide = 0.05;
  if (reported.gap > kWide * diagonal) {
    notes.push_back("neighbouring particles are up to " + short_number(reported.gap) + " apart: " +
                    (kind == LineKind::kStreaklines ? "a smaller --release-every draws" : "more seeds draw") +
                    " the lines finer");
  }
  if (reported.torn > 0) {
    notes.push_back(counted(reported.torn, kind == LineKind::kStreaklines ? "streakline" : "timeline") +
                    (reported.torn == 1 ? " is" : " are") +
                    " cut where particles have ended: each piece states why the next one has");
  }
}

/// How many of how many, and what helps.
std::string memory_text(const TraceResult& result, std::size_t seeds, const TracingOptions& tracing) {
  constexpr unsigned kMega = 20;
  return "lines begin at " + std::to_string(seeds - result.seeds_left_out) + " of " + counted(seeds, "seed") +
         ", which are spread over all of them: more would take more than the " +
         std::to_string(line_memory(tracing) >> kMega) +
         " MB of --memory; raise it, or give fewer --seeds or a shorter --max-length";
}

}  // namespace

void check_lines(const TracingOptions& tracing, const SeedSpec& seeds) {
  const LineKind kind = line_kind_from_name(tracing.lines);
  (void)time_order_from_name(tracing.time_order);
  if (kind == LineKind::kTimelines && !std::holds_alternative<SeedList>(seeds))
    throw usage_error(
        "timelines join neighbouring seeds: give seeds in a row, --seeds line:x,y,z,x,y,z,n or a file (in the "
        "window: seeds, row along x)");
}

LinesOfFlow trace_flow(Input& input, const VectorField& field, std::span<const Vec3> seeds,
                       const Document& document, const TraceOptions& trace, bool at_step,
                       Progress* progress) {
  LinesOfFlow lines;
  const TracingOptions& tracing = document.tracing;
  lines.kind = line_kind_from_name(tracing.lines);
  if (lines.kind == LineKind::kStreamlines) {
    lines.result = trace_lines(field, seeds, trace, progress);
    if (lines.result.seeds_left_out > 0) lines.memory_note = memory_text(lines.result, seeds.size(), tracing);
    return lines;
  }
  FlowSeries series(input, trace.threads);
  lines.notes = series.notes();
  // Of the streamlines that a session or a window had before.
  if (trace.integrator && *trace.integrator != Integrator::kDp54) {
    lines.notes.push_back("--integrator " + std::string(name_of(*trace.integrator)) +
                          " is of streamlines: " + tracing.lines + " are integrated by dp54");
  }
  if (trace.step > 0.0)
    lines.notes.push_back("--step is of streamlines: " + tracing.lines +
                          " have points at the steps of the integration");
  UnsteadyOptions options{.kind = lines.kind,
                          .order = time_order_from_name(tracing.time_order),
                          .until = tracing.until,
                          .every = tracing.release_every,
                          .trace = trace};
  options.trace.integrator.reset();
  options.trace.step = 0.0;
  const std::vector<double>& times = series.times();
  if (times.size() > 1) {
    const double own = input.times()[input.time().step];
    const bool begins = lines.kind == LineKind::kPathlines || trace.backward;
    options.from = tracing.release_from.value_or(begins ? own : times.front());
    if (!begins && !options.until && (at_step || !document.input.time.empty())) options.until = own;
    const double end = options.until.value_or(trace.backward ? times.front() : times.back());
    if (at_step && options.from == end) {
      lines.notes.push_back(tracing.lines + ": no time is between the release at " + exact_number(end) +
                            " and the end; move the slider of time");
      return lines;
    }
  }
  const auto read = [&](std::size_t step) { return series.read(step, progress); };
  UnsteadyResult traced = trace_unsteady(times, read, seeds, options, progress);
  for (std::string& note : series.field_notes(field.notes().lines)) lines.notes.push_back(std::move(note));
  lines.result = std::move(traced.trace);
  lines.in_time = traced.in_time;
  note(lines.in_time, lines.kind, field.diagonal(), lines.notes);
  return lines;
}

std::vector<PointColumn> moment_column(const LinesOfFlow& lines) {
  if (lines.kind == LineKind::kStreamlines) return {};
  PointColumn column{.name = "moment", .values = {}};
  for (const Line& line : lines.result.lines)
    column.values.insert(column.values.end(), line.points.size(), line.moment);
  return {std::move(column)};
}

std::string in_time_text(const InTime& in_time) {
  std::string text = "from " + short_number(in_time.from) + " until " + short_number(in_time.until) + ", " +
                     counted(in_time.releases, "release") + " of each seed, " +
                     counted(in_time.steps, "step") + " of the data (" +
                     std::to_string(in_time.steps_in_memory) + " in memory)";
  if (in_time.sampling_known)
    text += ", error of the sampling in time up to " + short_number(in_time.sampling);
  return text + ", of the integration up to " + short_number(in_time.integration);
}

}  // namespace palpate
