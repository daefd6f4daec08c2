#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "apps/flow/flow_verbs.h"
#include "common/base/clock.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/cli/report_output.h"
#include "common/cli/verbs.h"
#include "common/compose/resampled_volume.h"
#include "common/compose/trace_options.h"
#include "common/field/grid/box_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/scalar_choice.h"
#include "common/scene/plan.h"
#include "common/scene/seeds.h"
#include "lab/constraint_studies.h"
#include "lab/haptic_stability.h"
#include "lab/report.h"
#include "lab/resampling.h"
#include "lab/stability_sweep.h"

namespace palpate {
namespace {

/// Seeds to draw where none are given, and how many of their lines are compared: some end inside and are
/// dropped.
struct SeedPlan {
  const char* seeds;
  std::size_t lines;
};

SeedPlan seed_plan(Effort effort) {
  switch (effort) {
    case Effort::kQuick:
      return {"random:200", 16};
    case Effort::kThorough:
      return {"random:2000", 200};
    default:
      return {"random:500", 48};
  }
}

std::string grid_sentence(const VectorField& field) {
  if (const TetMesh* mesh = field.tet_mesh()) {
    return "The grid has " + std::to_string(mesh->cells().size()) + " tetrahedra, linear in each.";
  }
  if (const BoxGrid* grid = field.box_grid()) {
    const Index3 n = grid->points();
    return "The grid has " + std::to_string(n.x) + " x " + std::to_string(n.y) + " x " + std::to_string(n.z) +
           " points, trilinear in each cell.";
  }
  return "The field is a formula.";
}

std::string figures_text(const Report& report) {
  std::string text;
  for (const SweepRow& row : report.sweep.rows) {
    text += "  " + row.method + std::string(8 - std::min<std::size_t>(7, row.method.size()), ' ') +
            row.parameter + std::string(22 - std::min<std::size_t>(21, row.parameter.size()), ' ') +
            "error " + short_number(row.error.p95) + " in " + short_number(row.seconds) + " s\n";
  }
  text += "  reference " + report.sweep.reference + ", within " + short_number(report.sweep.agreement.p95) +
          " of " + report.sweep.second + "\n";
  for (const ConstraintRow& row : report.constraint.rows) {
    if (row.cells_swept || row.budget.iterations != UpdateBudget{}.iterations) continue;
    text += "  hand on a streamline, " + std::string(name_of(row.path)) + ": force error " +
            short_number(row.force_error.max) + " N, " + short_number(row.us_p99) + " us a step\n";
  }
  return text;
}

/// What it costs to draw scalars of the flow from another grid: the speed, which every flow has, and the
/// first scalar of the file.
ReportSection resampling(Input& input, const std::shared_ptr<const VectorField>& field,
                         const Options& options, Effort effort, Progress* progress) {
  std::vector<ResampledScalar> scalars;
  const auto add = [&](const std::string& name) {
    scalars.push_back({name, flow_sampler(name, input, field, options.common.threads, progress)});
  };
  add("speed");
  const std::vector<ScalarChoice> choices = scalar_choices(input.arrays());
  if (!choices.empty() && choices.front().component != ScalarChoice::kMagnitude)
    add(label_of(choices.front(), input.arrays()));
  return resampling_section(
      input.title(), run_resampling(scalars, field->bounds(), effort, options.common.threads, progress));
}

ExitCode run_report(const Options& options, const VerbContext& context) {
  Console& console = context.console;
  if (list_examples(options, context)) return ExitCode::kDone;
  if (options.out.empty()) throw usage_error("report needs a folder to make: try --out report");
  const Effort effort = effort_from_name(options.effort);
  const SeedSpec spec =
      parse_seeds(options.tracing.seeds.empty() ? seed_plan(effort).seeds : options.tracing.seeds);
  TraceOptions trace = trace_options(options, "forward");
  check_report_folder(options.out, options.common.force);

  const Stopwatch watch;
  Input input = open_input(options, context);
  console.note(input.choice_sentence());
  if (options.common.explain) {
    console.print(plan_text(
        plan_scene(input, {.verb = "report", .tracing = true, .threads = resolve_threads(trace.threads)})));
  }
  const auto field = input.load_field(options.common.threads, &context.progress);
  const auto seeds = make_seeds(spec, *field, options.common.seed);

  Report report = begin_report(input, context);
  report.scene.push_back(grid_sentence(*field));
  report.scene.insert(report.scene.end(), field->notes().lines.begin(), field->notes().lines.end());
  report.sweep =
      run_sweep(*field,
                {.subject = input.title() + ", " + field->name(),
                 .seeds = seeds,
                 .trace = trace,
                 .effort = effort,
                 .most_lines = options.tracing.seeds.empty() ? seed_plan(effort).lines : seeds.size()},
                &context.progress);

  std::vector<Vec3> followed;
  for (const Line& line : report.sweep.reference_lines) {
    if (line.direction != report.sweep.reference_lines.front().direction) continue;
    followed.push_back(line.points.front().position);
  }
  report.constraint = run_constraint_sweep(field,
                                           {.subject = report.sweep.subject,
                                            .seeds = std::move(followed),
                                            .effort = effort,
                                            .threads = options.common.threads},
                                           &context.progress);

  constexpr std::size_t kStabilitySeeds = 64;
  StabilityRequest stability{.seeds = seeds, .trace = trace};
  stability.seeds.resize(std::min(seeds.size(), kStabilitySeeds));
  stability.trace.max_length = report.sweep.max_length;
  if (input.file()) {
    stability.choice = input.choice();
    stability.file = input.spec().files.front().string();
    stability.blocks = input.read(stability.choice.arrays, &context.progress);
  }
  report.stability = run_stability(stability, &context.progress);
  append(run_haptic_stability(field, report.constraint, stability, &context.progress), report.stability);
  report.sections.push_back(resampling(input, field, options, effort, &context.progress));
  add_constraint_studies(report, effort, &context.progress);
  WallStability wall = run_wall_stability(options.common.threads, &context.progress);
  append(std::move(wall.cases), report.stability);
  for (ReportSection& section : wall_sections(wall)) report.sections.push_back(std::move(section));
  report.seconds = watch.seconds();

  finish_report(report, figures_text(report), report.sweep.rows.size(),
                measured_costs(input, field->tet_mesh()), options, context);
  return ExitCode::kDone;
}

}  // namespace

Verb report_verb(std::vector<UsageExample> examples) {
  return {.name = "report",
          .summary = "measure error against run time and stability on this very data",
          .groups = {.tracing = true, .out = true, .effort = true},
          .examples = std::move(examples),
          .run = run_report};
}

}  // namespace palpate
