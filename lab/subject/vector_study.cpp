#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "common/base/clock.h"
#include "common/base/text.h"
#include "common/compose/resampled_volume.h"
#include "common/compose/trace_options.h"
#include "common/field/grid/box_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/scalar_choice.h"
#include "common/scene/seeds.h"
#include "lab/data/resampling.h"
#include "lab/extremes/extreme.h"
#include "lab/hand/chain/chain_rivals.h"
#include "lab/hand/chain/chain_work.h"
#include "lab/hand/constraint/constraint_budget.h"
#include "lab/hand/constraint/linear_drift.h"
#include "lab/hand/constraint/surface_depth.h"
#include "lab/hand/haptic_stability.h"
#include "lab/hand/wall/stability_sweep.h"
#include "lab/study.h"

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
            (std::isfinite(row.error.p95) ? "error " + short_number(row.error.p95) : "fails") + " in " +
            short_number(row.seconds) + " s" +
            (row.error.failed() > 0 ? ", " + std::to_string(row.error.failed()) + " of " +
                                          counted(row.error.judged, "line") + " failed"
                                    : "") +
            "\n";
  }
  text += "  reference " + report.sweep.reference + ", within " + short_number(report.sweep.agreement.p95) +
          " of " + report.sweep.second +
          (report.sweep.disputed > 0 ? ", but they disagree on " + counted(report.sweep.disputed, "line")
                                     : std::string()) +
          "\n";
  if (!report.sweep.peer_missing.empty()) text += "  " + report.sweep.peer_missing + "\n";
  for (const ConstraintRow& row : report.constraint.rows) {
    if (row.cells_swept || row.budget.iterations != UpdateBudget{}.iterations) continue;
    text += "  hand on a streamline, " + std::string(name_of(row.path)) + ": force error " +
            short_number(row.force_error.max) + " N, " + short_number(row.us_p99) + " us a step\n";
  }
  return text;
}

/// What it costs to draw scalars of the flow from another grid: the speed, which every flow has, and the
/// first scalar of the file.
ReportSection resampling(Input& input, const std::shared_ptr<const VectorField>& field, int threads,
                         Effort effort, Progress* progress) {
  std::vector<ResampledScalar> scalars;
  const auto add = [&](const std::string& name) {
    scalars.push_back({name, flow_sampler(name, input, field, threads, progress)});
  };
  add("speed");
  const std::vector<ScalarChoice> choices = scalar_choices(input.arrays());
  if (!choices.empty() && choices.front().component != ScalarChoice::kMagnitude)
    add(label_of(choices.front(), input.arrays()));
  return resampling_section(input.title(),
                            run_resampling(scalars, field->bounds(), effort, threads, progress));
}

/// What chapter 6 of Ikits 2006 argues of constraints and chains, on features that are known in closed form.
void add_constraint_studies(Report& report, Effort effort, Progress* progress) {
  report.sections.push_back(constraint_budget_section(run_constraint_budget(effort, progress)));
  report.sections.push_back(linear_drift_section(run_linear_drift(progress)));
  report.sections.push_back(surface_depth_section(run_surface_depth(progress)));
  report.sections.push_back(chain_rivals_section(run_chain_rivals(progress)));
  const ChainWork work = run_chain_work(effort, progress);
  report.sections.push_back(chain_work_section(work));
  append(chain_work_cases(work), report.stability);
}

}  // namespace

ReportAnswer study_vectors(const Study& study) {
  const Document& document = study.document();
  const std::string& wanted = document.tracing.seeds;
  const Effort effort = study.effort();
  const SeedSpec spec = parse_seeds(wanted.empty() ? seed_plan(effort).seeds : wanted);
  TraceOptions trace = trace_options(document, "forward");
  check_report_folder(document.output.file, document.common.force);

  const Stopwatch watch;
  Input input = study.open();
  Progress* progress = study.progress();
  const auto field = input.load_field(study.threads(), progress);
  const auto seeds = make_seeds(spec, *field, document.common.seed);

  Report report = study.begin(input);
  report.scene.push_back(grid_sentence(*field));
  report.scene.insert(report.scene.end(), field->notes().lines.begin(), field->notes().lines.end());
  report.sweep = run_sweep(*field,
                           {.subject = input.title() + ", " + field->name(),
                            .seeds = seeds,
                            .trace = trace,
                            .effort = effort,
                            .most_lines = wanted.empty() ? seed_plan(effort).lines : seeds.size()},
                           progress);

  std::vector<Vec3> followed;
  for (const Line& line : report.sweep.reference_lines) {
    if (line.direction != report.sweep.reference_lines.front().direction) continue;
    followed.push_back(line.points.front().position);
  }
  report.constraint = run_constraint_sweep(field,
                                           {.subject = report.sweep.subject,
                                            .seeds = std::move(followed),
                                            .effort = effort,
                                            .threads = study.threads()},
                                           progress);

  constexpr std::size_t kStabilitySeeds = 64;
  StabilityRequest stability{.seeds = seeds, .trace = trace};
  stability.seeds.resize(std::min(seeds.size(), kStabilitySeeds));
  stability.trace.max_length = report.sweep.max_length;
  if (input.file()) {
    stability.choice = input.choice();
    stability.file = input.spec().files.front().string();
    stability.blocks = input.read(stability.choice.arrays, progress);
  }
  report.stability = run_stability(stability, progress);
  append(run_extremes({ExtremeKind::kField, ExtremeKind::kMesh, ExtremeKind::kDevice}, progress),
         report.stability);
  append(run_haptic_stability(field, report.constraint, stability, progress), report.stability);
  report.sections.push_back(resampling(input, field, study.threads(), effort, progress));
  add_constraint_studies(report, effort, progress);
  WallStability wall = run_wall_stability(study.threads(), progress);
  append(std::move(wall.cases), report.stability);
  for (ReportSection& section : wall_sections(wall)) report.sections.push_back(std::move(section));
  report.seconds = watch.seconds();
  return study.finish(report, figures_text(report), report.sweep.rows.size());
}

}  // namespace palpate
