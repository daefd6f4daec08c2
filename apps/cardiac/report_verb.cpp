#include <string>
#include <vector>

#include "apps/cardiac/cardiac_verbs.h"
#include "apps/cardiac/heart_scene.h"
#include "common/base/clock.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/cli/report_output.h"
#include "common/cli/verbs.h"
#include "common/field/grid/mesh_quality.h"
#include "common/field/grid/tet_mesh.h"
#include "common/scene/plan.h"
#include "common/scene/seeds.h"
#include "lab/fibre_feel.h"
#include "lab/heart_errors.h"
#include "lab/report.h"

namespace palpate {
namespace {

const char* seeds_of(Effort effort) {
  return effort == Effort::kQuick ? "random:40" : effort == Effort::kNormal ? "random:200" : "random:1000";
}

std::string mesh_sentence(const ScalarField& layer) {
  const MeshQuality quality = mesh_quality(*layer.tet_mesh());
  const double scale = layer.frame().length_scale();
  return "The mesh has " + counted(quality.cells, "tetrahedron") + " with " +
         counted(quality.slivers, "sliver") + " (" + short_number(quality.least_angle) + " to " +
         short_number(quality.largest_angle) + " degrees between faces), fills a volume of " +
         short_number(quality.volume * scale * scale * scale) + " and has " +
         counted(quality.components, "part") + ".";
}

ExitCode run_heart_report(const Options& options, const VerbContext& context) {
  Console& console = context.console;
  if (list_examples(options, context)) return ExitCode::kDone;
  if (options.out.empty()) throw usage_error("report needs a folder to make: try --out report");
  const Effort effort = effort_from_name(options.effort);
  const double depth = layer_of(options.heart).value_or(kViewLayer);
  check_report_folder(options.out, options.common.force);

  const Stopwatch watch;
  const int threads = options.common.threads;
  Input input = open_input(options, context);
  console.note(input.choice_sentence());
  if (options.common.explain) {
    console.print(plan_text(
        plan_scene(input, {.verb = "report", .tracing = true, .threads = resolve_threads(threads)})));
  }
  const auto heart = load_layered_heart(input, options.heart, threads, &context.progress);
  const ScalarField& layer = *heart->heart().layer;
  const std::vector<Vec3> seeds = make_seeds(parse_seeds(seeds_of(effort)), *layer.tet_mesh(), heart->frame(),
                                             layer.bounds(), options.common.seed);

  Report report = begin_report(input, context);
  report.scene.push_back(mesh_sentence(layer));
  for (const std::string& note : heart->heart().notes) report.scene.push_back(note + ".");
  report.scene.push_back("Opening it took " +
                         short_number(input.seconds_open() + input.seconds_read() + input.seconds_field()) +
                         " s.");

  const std::vector<HeartErrorRow> meshes = run_heart_errors(effort, threads, &context.progress);
  const FibreLineErrors known = run_ventricle_lines(effort, threads, &context.progress);
  const FibreLineErrors lines =
      run_fibre_lines(input.title(), *heart, depth, seeds, nullptr, effort, threads, &context.progress);
  const FibreFeel feel = run_fibre_feel(heart, effort, &context.progress);
  const std::vector<FrictionRow> friction = run_friction(effort, &context.progress);
  report.sections = {heart_errors_section(meshes), fibre_lines_section({known, lines}),
                     fibre_feel_section(input.title(), feel, friction)};
  append(heart_error_cases(meshes, known), report.stability);
  append(fibre_feel_cases(feel, friction), report.stability);
  report.seconds = watch.seconds();

  finish_report(report, {}, work_precision_rows(report), measured_costs(input, layer.tet_mesh()), options,
                context);
  return ExitCode::kDone;
}

}  // namespace

Verb heart_report_verb(std::vector<UsageExample> examples) {
  return {.name = "report",
          .summary = "measure what mesh and step cost in volume, layers, angles, fibres and touch",
          .groups = {.layer = true, .out = true, .effort = true},
          .examples = std::move(examples),
          .run = run_heart_report};
}

}  // namespace palpate
