#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/base/text.h"
#include "common/field/grid/mesh_quality.h"
#include "common/field/grid/tet_mesh.h"
#include "common/scene/seeds.h"
#include "common/scene/wall/heart_layer.h"
#include "lab/data/heart_errors.h"
#include "lab/extremes/extreme.h"
#include "lab/hand/constraint/fibre_feel.h"
#include "lab/study.h"

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

}  // namespace

ReportAnswer study_fibres(const Study& study) {
  const Document& document = study.document();
  const Effort effort = study.effort();
  const double depth = layer_of(document.heart).value_or(kViewLayer);
  check_report_folder(document.output.file, document.common.force);

  const Stopwatch watch;
  const int threads = study.threads();
  Progress* progress = study.progress();
  Input input = study.open();
  const auto heart = std::make_shared<const LayeredHeart>(input.load_heart(threads, progress));
  const ScalarField& layer = *heart->heart().layer;
  const std::vector<Vec3> seeds = make_seeds(parse_seeds(seeds_of(effort)), *layer.tet_mesh(), heart->frame(),
                                             layer.bounds(), document.common.seed);

  Report report = study.begin(input);
  report.scene.push_back(mesh_sentence(layer));
  for (const std::string& note : heart->heart().notes) report.scene.push_back(note + ".");
  report.scene.push_back("Opening it took " +
                         short_number(input.seconds_open() + input.seconds_read() + input.seconds_field()) +
                         " s.");

  const std::vector<HeartErrorRow> meshes = run_heart_errors(effort, threads, progress);
  const FibreLineErrors known = run_ventricle_lines(effort, threads, progress);
  const FibreLineErrors lines =
      run_fibre_lines(input.title(), *heart, depth, seeds, nullptr, effort, threads, progress);
  const FibreFeel feel = run_fibre_feel(heart, effort, progress);
  const std::vector<FrictionRow> friction = run_friction(effort, progress);
  report.sections = {heart_errors_section(meshes), fibre_lines_section({known, lines}),
                     fibre_feel_section(input.title(), feel, friction)};
  append(heart_error_cases(meshes, known), report.stability);
  append(fibre_feel_cases(feel, friction), report.stability);
  append(run_extremes({ExtremeKind::kMesh, ExtremeKind::kDevice}, progress), report.stability);
  report.seconds = watch.seconds();
  return study.finish(report, {}, work_precision_rows(report));
}

}  // namespace palpate
