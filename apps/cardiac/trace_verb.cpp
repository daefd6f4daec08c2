#include <algorithm>
#include <string>
#include <utility>

#include "apps/cardiac/cardiac_verbs.h"
#include "apps/cardiac/heart_scene.h"
#include "common/base/clock.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/cli/json/json_output.h"
#include "common/cli/summaries.h"
#include "common/cli/trace_text.h"
#include "common/cli/verbs.h"
#include "common/field/grid/tet_mesh.h"
#include "common/load/write/write_lines.h"
#include "common/scene/seeds.h"

namespace palpate {
namespace {

std::string summary_text(const TraceSummary& summary, double step) {
  std::string text = trace_counts_text(summary);
  text += "  field      " + summary.field + "\n";
  text += "  method     rk4, steps of " + short_number(step) + ", longest line allowed " +
          short_number(summary.max_length) + "\n";
  return text + trace_error_text(summary) + trace_seconds_text(summary);
}

std::string failure_of(const TraceSummary& summary) {
  if (summary.seeds == 0) return "no line: there are no seeds; the mesh has no volume to draw them from";
  const TraceResult& result = summary.result;
  if (result.lines.empty())
    return "no line: all " + counted(summary.seeds, "seed") + " lie outside the wall, or off the layer";
  const bool any = std::any_of(result.lines.begin(), result.lines.end(),
                               [](const Line& line) { return line.points.size() > 1; });
  return any ? std::string() : "no line: fibres are not known, or not defined, at any seed";
}

/// The helix angle beside each point, where it has an axis to be measured from; else a word about it.
std::vector<PointColumn> columns_of(const std::shared_ptr<const LayeredHeart>& heart,
                                    const HeartOptions& options, const std::vector<Line>& lines, int threads,
                                    Console& console) {
  std::vector<PointColumn> columns;
  HeartOptions asked = options;
  for (const char* angle : {"depth", "gap", "helix"}) {
    asked.angle = angle;
    const bool axis = !asked.axis.empty() || heart->heart().axis || long_axis(*heart->heart().layer);
    if (asked.angle == "helix" && !axis) {
      console.note(
          "no helix angle beside the points: the wall does not open to one side; --axis x,y,z names the "
          "direction from apex to base");
      continue;
    }
    columns.push_back({angle, angles_along(AngleProbe(heart, asked), lines, threads)});
  }
  return columns;
}

ExitCode run_trace(const Document& options, const VerbContext& context) {
  Console& console = context.console;
  if (list_examples(options, context)) return ExitCode::kDone;
  if (options.tracing.seeds.empty())
    throw usage_error("trace needs seeds: try --seeds random:100 or --seeds grid:8,8,8");
  if (options.output.file.empty() && !options.common.json && !options.common.explain)
    throw usage_error("trace needs an output: try --out fibres.vtp (or --json to get the counts alone)");
  const SeedSpec spec = parse_seeds(options.tracing.seeds);
  const auto layer = layer_of(options.heart);
  if (!options.output.file.empty()) check_line_output(options.output.file, options.common.force);

  Input input = open_input(options, context);
  console.note(input.choice_sentence());
  TraceSummary summary;
  summary.input = input.title();
  summary.output = options.output.file.string();
  summary.threads = resolve_threads(options.common.threads);
  const auto heart = load_layered_heart(input, options.heart, options.common.threads, &context.progress);
  for (const std::string& note : heart->heart().notes) console.note(input.title() + ": " + note);
  const ScalarField& depth = *heart->heart().layer;
  summary.seconds_load = input.seconds_open() + input.seconds_read() + input.seconds_field();
  summary.field = input.field_label() + (layer ? " on the layer of depth " + short_number(*layer)
                                               : std::string(" through the wall"));
  summary.diagonal = depth.diagonal();
  summary.seed_points =
      make_seeds(spec, *depth.tet_mesh(), heart->frame(), depth.bounds(), options.common.seed);
  summary.seeds = summary.seed_points.size();
  FibreLineResult traced = trace_fibres(*heart, summary.seed_points,
                                        {.layer = layer,
                                         .step = options.tracing.step,
                                         .max_length = options.tracing.max_length,
                                         .least_gap = options.heart.least_gap,
                                         .forward = options.tracing.direction != "backward",
                                         .backward = options.tracing.direction != "forward",
                                         .threads = options.common.threads},
                                        &context.progress);
  summary.max_length = traced.max_length;
  summary.result = {.lines = std::move(traced.lines),
                    .outside_seeds = std::move(traced.outside_seeds),
                    .ends = traced.ends,
                    .points = traced.points,
                    .errors = std::move(traced.errors),
                    .seconds_trace = traced.seconds,
                    .integrator = Integrator::kRk4};
  const std::size_t outside = summary.result.outside_seeds.size();
  if (outside > 0)
    console.note(counted(outside, "seed") + " outside the wall, or off the layer, gave no line");
  summary.failure = failure_of(summary);
  if (!summary.failure.empty()) {
    summary.output.clear();
    console.print_json(trace_json(summary));
    throw work_error(summary.failure);
  }
  // No way leads on from a seed where fibres are not known.
  const std::size_t short_ones =
      std::erase_if(summary.result.lines, [](const Line& line) { return line.points.size() < 2; });
  summary.result.points -= short_ones;
  if (short_ones > 0)
    console.note(counted(short_ones, "line") +
                 " of one point left out: fibres are not known, or not defined, at their seeds");
  if (!options.output.file.empty()) {
    context.progress.begin("writing " + options.output.file.string(), 0);
    const Stopwatch watch;
    write_lines(options.output.file, summary.result.lines, options.common.force,
                columns_of(heart, options.heart, summary.result.lines, options.common.threads, console));
    summary.seconds_write = watch.seconds();
    context.interrupt.keep(options.output.file);
  }
  console.print(summary_text(summary, traced.step));
  console.print_json(trace_json(summary));
  return ExitCode::kDone;
}

}  // namespace

Verb trace_fibres_verb(std::vector<UsageExample> examples) {
  return {.name = "trace",
          .summary = "trace fibres, on a layer or through the wall, and write them to a file",
          .groups = {Group::kInput, Group::kLines, Group::kLayer, Group::kOut},
          .examples = std::move(examples),
          .run = run_trace};
}

}  // namespace palpate
