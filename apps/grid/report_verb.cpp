#include <string>
#include <vector>

#include "apps/grid/grid_verbs.h"
#include "common/base/clock.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/cli/report_output.h"
#include "common/cli/verbs.h"
#include "common/compose/volume_fields.h"
#include "common/compose/volume_scene.h"
#include "common/haptics/workspace.h"
#include "common/scene/plan.h"
#include "lab/html.h"
#include "lab/plane_placing.h"
#include "lab/report.h"
#include "lab/volume_quality.h"

namespace palpate {
namespace {

std::string figures_text(const VolumeQuality& quality) {
  std::string text;
  for (const VolumeQualityRow& row : quality.rows) {
    text += "  " + row.method + " " + short_number(row.parameter) + ": error " + three_digits(row.rms) +
            " in " + three_digits(row.milliseconds) + " ms\n";
  }
  return text;
}

/// Planes are placed among the voxels of the image, in the default workspace.
PlacingSettings placing_settings(const VolumeImage& image, Effort effort, std::uint64_t seed) {
  PlacingSettings settings{.seed = seed};
  settings.voxel = Workspace::default_scale(image.bounds().diagonal()) * glm::length(image.axes[0]);
  constexpr int kFew = 6, kMany = 200;
  if (effort == Effort::kQuick) settings.trials = kFew;
  if (effort == Effort::kThorough) settings.trials = kMany;
  return settings;
}

ExitCode run_volume_report(const Options& options, const VerbContext& context) {
  Console& console = context.console;
  if (list_examples(options, context)) return ExitCode::kDone;
  if (options.out.empty()) throw usage_error("report needs a folder to make: try --out report");
  const Effort effort = effort_from_name(options.effort);
  check_volume_options(options.volume);
  check_report_folder(options.out, options.common.force);

  const Stopwatch watch;
  Input input = open_input(options, context);
  console.note(input.choice_sentence());
  (void)input.scalar_choice();  // an unknown --field is refused before anything is read
  if (options.common.explain) {
    console.print(plan_text(plan_scene(
        input, {.verb = "report", .threads = resolve_threads(options.common.threads), .drawing = true})));
  }
  const SceneView scene =
      make_volume_scene(input, load_seen_volume(input, options.volume, &context.progress), options, 1.0);
  Report report = begin_report(input, context);
  report.scene.push_back(scene.subtitle + ".");
  const VolumeQuality quality = run_volume_quality(*scene.volume, input.title(), effort, &context.progress);
  report.sections = volume_quality_sections(quality);
  const PlacingSettings placing = placing_settings(*scene.volume->image, effort, options.common.seed);
  const std::vector<PlacingRow> placed = run_plane_placing(placing, &context.progress);
  report.sections.push_back(plane_placing_section(placed, placing));
  report.stability = plane_placing_cases(placed);
  report.seconds = watch.seconds();

  finish_report(report, figures_text(quality), quality.rows.size(), measured_costs(input, nullptr), options,
                context);
  return ExitCode::kDone;
}

}  // namespace

Verb volume_report_verb(std::vector<UsageExample> examples) {
  return {.name = "report",
          .summary = "measure what ways to draw this volume faster cost in errors of its picture",
          .groups = {.view = true, .out = true, .effort = true},
          .examples = std::move(examples),
          .run = run_volume_report};
}

}  // namespace palpate
