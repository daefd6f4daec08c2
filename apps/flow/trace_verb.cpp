#include <algorithm>
#include <utility>

#include "apps/flow/flow_verbs.h"
#include "common/base/clock.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/cli/json/json_output.h"
#include "common/cli/summaries.h"
#include "common/cli/trace_text.h"
#include "common/cli/verbs.h"
#include "common/compose/lines_of_flow.h"
#include "common/compose/trace_options.h"
#include "common/load/write/write_lines.h"
#include "common/math/vec_text.h"
#include "common/scene/seeds.h"

namespace palpate {
namespace {

constexpr double kDefaultDiagonals = 10.0;  // --max-length where it is not given (trace.h)
constexpr std::size_t kMostSeedsNamed = 5;

std::string bounds_text(const Box& box) {
  return position_text(box.lower) + " to " + position_text(box.upper);
}

/// What to change where lines ended by a limit or by the data.
std::vector<std::string> advice_for(const TraceSummary& summary) {
  std::vector<std::string> advice;
  const TraceResult& result = summary.result;
  const auto add = [&](End end, const std::string& what) {
    const std::size_t count = result.ends[as_size(end)];
    if (count > 0)
      advice.push_back(counted(count, "line") + " ended by " + std::string(name_of(end)) + ": " + what);
  };
  add(End::kMaxLength, "--max-length above " + short_number(summary.max_length) + " follows them further");
  add(End::kMaxTime, "a longer --max-time follows them further");
  add(End::kMaxSteps, "raise --max-steps, or loosen --tolerance " + short_number(summary.tolerance) +
                          "; dp54 and rodas4 take the longest steps");
  add(End::kBadData, "values there are NaN, infinite or blanked, or cells lie over one another");
  return advice;
}

std::string outside_text(const TraceSummary& summary, const Box& bounds) {
  const auto& outside = summary.result.outside_seeds;
  std::string text = counted(outside.size(), "seed") + " outside the data gave no line:";
  for (std::size_t i = 0; i < std::min(outside.size(), kMostSeedsNamed); ++i) {
    text += (i == 0 ? " " : ", ") + std::to_string(outside[i]) + " " +
            position_text(summary.seed_points[outside[i]]);
  }
  if (outside.size() > kMostSeedsNamed) text += ", …";
  return text + "; the data spans " + bounds_text(bounds);
}

/// Why nothing was traced, or empty.
std::string failure_of(const TraceSummary& summary, const VectorField& field) {
  const TraceResult& result = summary.result;
  if (summary.seeds == 0) return "no line: there are no seeds; the mesh has no volume to draw them from";
  if (result.lines.empty()) {
    return "no line: all " + counted(summary.seeds, "seed") + " lie outside the data, which spans " +
           bounds_text(field.bounds());
  }
  const bool any = std::any_of(result.lines.begin(), result.lines.end(),
                               [](const Line& line) { return line.points.size() > 1; });
  const bool in_time = summary.kind == LineKind::kStreaklines || summary.kind == LineKind::kTimelines;
  if (any || (in_time && result.ends[as_size(End::kEndOfTime)] > 0)) return {};
  if (field.max_speed() == 0.0 && field.notes().bad_values > 0)
    return "no line: field " + summary.field +
           " has no value but zero that is a number; try another --field or --time";
  if (field.max_speed() == 0.0)
    return "no line: field " + summary.field + " is zero everywhere; try another --field";
  if (result.ends[as_size(End::kBadData)] == result.lines.size()) {
    return "no line: every seed lies where the data is NaN, infinite or blanked; choose other --seeds";
  }
  if (result.ends[as_size(End::kLeftDomain)] == result.lines.size())
    return "no line: every seed lies on the border, where the flow leaves; choose other --seeds, or --direction both";
  return "no line: the field does not move any seed (stagnation " +
         std::to_string(result.ends[as_size(End::kStagnation)]) + ", bad_data " +
         std::to_string(result.ends[as_size(End::kBadData)]) + "); choose other --seeds";
}

std::string summary_text(const TraceSummary& summary) {
  std::string text = trace_counts_text(summary);
  const StepCounts& steps = summary.result.steps;
  const Integrator used = summary.result.integrator;
  const std::int64_t stiff = used == Integrator::kRodas4 ? 0 : steps[as_size(Integrator::kRodas4)];
  text += "  method     " + std::string(name_of(used)) + ", " + std::to_string(steps[as_size(used)]) +
          " steps" +
          (stiff > 0 ? " and " + std::to_string(stiff) + " of rodas4 where the flow is stiff" : "") +
          ", tolerance " + short_number(summary.tolerance) + ", longest line allowed " +
          short_number(summary.max_length) + " (" + short_number(summary.max_length / summary.diagonal) +
          " diagonals)\n";
  if (summary.kind != LineKind::kStreamlines) {
    text += "  " + std::string(name_of(summary.kind)) +
            (summary.kind == LineKind::kStreaklines ? " " : "  ") + in_time_text(summary.in_time) + "\n";
  }
  text += trace_error_text(summary) + trace_seconds_text(summary);
  for (const std::string& advice : summary.advice) text += "  note       " + advice + "\n";
  return text;
}

ExitCode run_trace(const Document& options, const VerbContext& context) {
  Console& console = context.console;
  if (list_examples(options, context)) return ExitCode::kDone;

  // Everything that can be refused is refused before any work is done.
  if (options.tracing.seeds.empty()) {
    throw usage_error("trace needs seeds: try --seeds grid:8,8,8 or --seeds random:100");
  }
  if (options.output.file.empty() && !options.common.json && !options.common.explain) {
    throw usage_error("trace needs an output: try --out lines.vtp (or --json to get the counts alone)");
  }
  const SeedSpec spec = parse_seeds(options.tracing.seeds);
  check_lines(options.tracing, spec);
  const TraceOptions trace = trace_options(options, "forward");
  if (!options.output.file.empty()) check_line_output(options.output.file, options.common.force);

  Input input = open_input(options, context);
  console.note(input.choice_sentence());
  TraceSummary summary;
  summary.input = input.title();
  summary.output = options.output.file.string();

  const auto field = input.load_field(options.common.threads, &context.progress);
  for (const std::string& note : field->notes().lines) console.note(input.title() + ": " + note);
  summary.seconds_load = input.seconds_open() + input.seconds_read() + input.seconds_field();
  summary.field = field->name();
  summary.diagonal = field->diagonal();
  summary.max_length = trace.max_length > 0.0 ? trace.max_length : kDefaultDiagonals * field->diagonal();
  summary.tolerance = trace.tolerance;
  summary.threads = resolve_threads(trace.threads);
  summary.seed_points = make_seeds(spec, *field, options.common.seed);
  summary.seeds = summary.seed_points.size();

  LinesOfFlow traced =
      trace_flow(input, *field, summary.seed_points, options, trace, false, &context.progress);
  const std::vector<PointColumn> moments = moment_column(traced);
  summary.result = std::move(traced.result);
  summary.kind = traced.kind;
  summary.in_time = traced.in_time;
  summary.advice = advice_for(summary);
  if (const double rounding = field->value_rounding(); trace.tolerance < rounding)
    summary.advice.push_back("--tolerance " + short_number(trace.tolerance) +
                             " cannot be kept: values are of single precision, off by " +
                             short_number(rounding));
  if (!traced.memory_note.empty()) summary.advice.push_back(traced.memory_note);
  summary.advice.insert(summary.advice.end(), traced.notes.begin(), traced.notes.end());
  summary.failure = failure_of(summary, *field);
  if (!summary.result.outside_seeds.empty()) console.note(outside_text(summary, field->bounds()));

  if (!summary.failure.empty()) {
    summary.output.clear();
    console.print_json(trace_json(summary));
    throw work_error(summary.failure);
  }
  if (!options.output.file.empty()) {
    context.progress.begin("writing " + options.output.file.string(), 0);
    const Stopwatch watch;
    write_lines(options.output.file, summary.result.lines, options.common.force, moments);
    summary.seconds_write = watch.seconds();
    context.interrupt.keep(options.output.file);
  }
  console.print(summary_text(summary));
  console.print_json(trace_json(summary));
  return ExitCode::kDone;
}

}  // namespace

Verb trace_verb(std::vector<UsageExample> examples) {
  return {.name = "trace",
          .summary = "trace lines from seeds and write them to a file",
          .groups = {Group::kInput, Group::kLines, Group::kOut},
          .examples = std::move(examples),
          .run = run_trace};
}

}  // namespace palpate
