#include <optional>
#include <string>
#include <utility>

#include "apps/dtmri/dtmri_verbs.h"
#include "apps/dtmri/tract_request.h"
#include "apps/dtmri/tract_table.h"
#include "common/base/clock.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/cli/json/json_output.h"
#include "common/cli/summaries.h"
#include "common/cli/verbs.h"
#include "common/field/tensor/tensor_measure.h"
#include "common/load/write/write_lines.h"
#include "common/load/write/write_tractogram.h"
#include "common/scene/tensor/tensor_spec.h"
#include "common/trace/tract/tract_errors.h"

namespace palpate {
namespace {

/// @param peaks lines followed these.
std::vector<std::string> advice_for(const TractSummary& summary, bool peaks) {
  std::vector<std::string> advice;
  const TractResult& result = summary.result;
  const auto add = [&](End end, const std::string& what) {
    const std::size_t count = result.end_counts[as_size(end)];
    if (count > 0) advice.push_back(counted(count, "end") + " by " + std::string(name_of(end)) + ": " + what);
  };
  add(End::kMaxLength, "--max-length above " + short_number(result.max_length) + " follows them further");
  add(End::kSharpTurn, (peaks ? "where there are peaks, none within 45 degrees of the way; or " : "") +
                           std::string("--max-angle above ") + short_number(result.max_angle) +
                           " lets them turn");
  add(End::kMaxSteps,
      "--max-steps above " + std::to_string(summary.options.max_steps) + " follows them further");
  return advice;
}

/// Why there is no line, or empty.
std::string failure_of(const TractSummary& summary) {
  if (summary.result.lines.line_count() > 0) return {};
  return "no line: " + why_no_tract(summary.result, summary.options);
}

std::string dropped_text(const TractsDropped& d) {
  std::string text;
  const auto add = [&text](std::size_t count, const char* what) {
    if (count > 0) text += (text.empty() ? "" : ", ") + std::string(what) + " " + std::to_string(count);
  };
  add(d.outside, "seeds outside");
  add(d.bad_data, "seeds without a tensor");
  add(d.below_cutoff, "seeds below the cut-off");
  add(d.too_short, "too short");
  add(d.not_included, "not included");
  add(d.excluded, "excluded");
  return text;
}

std::string summary_text(const TractSummary& summary) {
  const TractResult& result = summary.result;
  std::string text = summary.input + ": " + counted(summary.seeds, "seed") + ", " +
                     counted(result.lines.line_count(), "line") + ", " +
                     counted(result.lines.points.size(), "point");
  text += summary.output.empty() ? "\n" : " -> " + summary.output + "\n";
  std::string ends;
  for (int e = 0; e < kEndCount; ++e) {
    const std::size_t count = result.end_counts[as_size(e)];
    if (count > 0) {
      ends += (ends.empty() ? "" : ", ") + std::string(name_of(static_cast<End>(e))) + " " +
              std::to_string(count);
    }
  }
  text +=
      "  ends       " + ends +
      (summary.options.sense == TractSense::kBoth ? " (two a line)\n"
                                                  : " (two a line; its seed counts as stopped_by_rule)\n");
  if (const std::string dropped = dropped_text(result.dropped); !dropped.empty()) {
    text += "  dropped    " + dropped + "\n";
  }
  text += "  method     " + std::string(name_of(summary.options.integrator)) + ", step " +
          short_number(result.step) + ", " + std::string(name_of(summary.options.measure)) + " from " +
          short_number(summary.options.cutoff) + ", turns to " + short_number(result.max_angle) +
          " degrees a step, length to " + short_number(result.max_length) + "\n";
  text += "  " + errors_text(summary.errors) + " by their own estimate (sum of the steps')";
  if (summary.errors.within)
    text += ", " + std::to_string(*summary.errors.within) + " of " +
            counted(result.lines.line_count(), "line") + " within the tolerance";
  text += "\n";
  text += "  seconds    load " + short_number(summary.seconds_load) + ", prepare " +
          short_number(summary.seconds_prepare) + ", trace " + short_number(result.seconds) + " (" +
          counted(static_cast<std::uint64_t>(summary.threads), "thread") + ")\n";
  for (const std::string& advice : summary.advice) text += "  note       " + advice + "\n";
  return text;
}

/// "0 left_domain, 1 stagnation, …"
std::string end_numbers() {
  std::string text;
  for (int e = 0; e < kEndCount; ++e)
    text += (e == 0 ? "" : ", ") + std::to_string(e) + " " + std::string(name_of(static_cast<End>(e)));
  return text;
}

/// What files say of each line: its seed, and why its first and its last point are its ends.
void add_line_columns(TractResult& result) {
  Tractogram::Column seed{.name = "seed", .values = {}}, first{.name = "termination_first", .values = {}},
      last{.name = "termination_last", .values = {}};
  for (std::size_t l = 0; l < result.lines.line_count(); ++l) {
    seed.values.push_back(static_cast<float>(result.seeds[l]));
    first.values.push_back(static_cast<float>(result.ends[l][0]));
    last.values.push_back(static_cast<float>(result.ends[l][1]));
  }
  result.lines.of_lines = {std::move(seed), std::move(first), std::move(last)};
}

ExitCode run_trace(const Document& options, const VerbContext& context) {
  Console& console = context.console;
  if (list_examples(options, context)) return ExitCode::kDone;

  // Everything that can be refused is refused before any work is done.
  if (options.tracts.seeds.empty()) {
    throw usage_error("trace needs seeds: try --seeds fa:0.4, or --seeds point:x,y,z");
  }
  if (options.output.file.empty() && !options.common.json && !options.common.explain) {
    throw usage_error("trace needs an output: try --out tracts.tck (or --json to get the counts alone)");
  }
  if (!options.output.file.empty()) check_line_output(options.output.file, options.common.force);
  const int threads = options.common.threads;
  TractSummary summary;
  Stopwatch regions;
  const bool left_handed = parse_tensor_spec(options.input.tensor).left_handed;
  TractRequest request = tract_request(options.tracts, left_handed, threads, &context.progress);
  const double seconds_regions = regions.seconds();

  Input input = open_input(options, context);
  console.note(input.choice_sentence());
  summary.input = input.title();
  summary.output = options.output.file.string();
  summary.threads = resolve_threads(threads);

  const TensorImage image =
      input.load_tensor_image(threads, &context.progress, options.tracts.max_cone.has_value());
  for (const std::string& note : image.notes) console.note(input.title() + ": " + note);
  summary.seconds_load = input.seconds_open() + input.seconds_read();
  const Stopwatch prepare;
  const auto field = make_tensor_field(image.image, image.choice, input.title(), threads);
  for (const std::string& note : field->notes().lines) console.note(input.title() + ": " + note);
  summary.field = input.field_label();
  std::vector<std::string> of_masks = check_regions(request, image.image);
  std::vector<Vec3> seeds = tract_seeds(options.tracts, left_handed, options.common.seed, *field, image.image,
                                        of_masks, &context.progress);
  if (options.tracts.max_cone)
    stop_where_unsure(options.tracts, field->voxels().value_or(UniformTopology()),
                      image.image.find(std::string(kConeArray), Association::kPoint), request, seeds,
                      of_masks);
  for (const std::string& note : of_masks) console.note(note);
  summary.options = request.options;
  summary.seeds = seeds.size();
  summary.seconds_prepare = seconds_regions + prepare.seconds();

  summary.result = trace_tracts(*field, seeds, summary.options, &context.progress);
  const bool controlled = summary.options.integrator == Integrator::kDp54;
  summary.errors = tract_errors(summary.result, field->bounds().diagonal(),
                                controlled ? std::optional(summary.options.tolerance) : std::nullopt);
  summary.advice = advice_for(summary, field->peaks() != nullptr);
  summary.failure = failure_of(summary);
  if (!summary.failure.empty()) {
    summary.output.clear();
    console.print_json(tract_json(summary));
    throw work_error(summary.failure);
  }
  if (!options.output.file.empty()) {
    context.progress.begin("writing " + options.output.file.string(), 0);
    const Stopwatch watch;
    const std::string ending = lower_ending(options.output.file);
    if (ending == ".tck")
      console.note(
          "a .tck file has no place for error, seed and termination: left out; .trk, .vtp and .csv have");
    if (ending == ".trk" || ending == ".vtp")
      console.note("termination_first and termination_last are numbers in a " + ending +
                   " file: " + end_numbers() + "; .csv has names");
    add_line_columns(summary.result);
    if (const auto* const voxels = std::get_if<UniformTopology>(&image.image.topology)) {
      summary.result.lines.image = {.voxels = voxels->points, .axes = voxels->axes, .origin = voxels->origin};
    }
    if (ending == ".csv") {
      write_tract_table(options.output.file, summary.result, seeds, options.common.force);
    } else {
      write_tractogram(options.output.file, summary.result.lines, options.common.force);
    }
    summary.seconds_write = watch.seconds();
    context.interrupt.keep(options.output.file);
  }
  console.print(summary_text(summary));
  console.print_json(tract_json(summary));
  return ExitCode::kDone;
}

}  // namespace

Verb trace_tracts_verb(std::vector<UsageExample> examples) {
  return {.name = "trace",
          .summary = "trace tracts from seeds and write them to a file",
          .groups = {Group::kInput, Group::kLines, Group::kOut},
          .examples = std::move(examples),
          .run = run_trace};
}

}  // namespace palpate
