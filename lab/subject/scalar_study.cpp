#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/base/text.h"
#include "common/compose/volume_fields.h"
#include "common/compose/volume_scene.h"
#include "common/haptics/workspace.h"
#include "lab/data/volume_extremes.h"
#include "lab/data/volume_quality.h"
#include "lab/extremes/extreme.h"
#include "lab/hand/plane_placing.h"
#include "lab/page/html.h"
#include "lab/study.h"

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

}  // namespace

ReportAnswer study_scalars(const Study& study) {
  const Document& document = study.document();
  const Effort effort = study.effort();
  check_volume_options(document.volume);
  check_report_folder(document.output.file, document.common.force);

  const Stopwatch watch;
  Input input = study.open();
  (void)input.scalar_choice();  // an unknown --field is refused before anything is read
  Resampling resampling{.asked = document.volume.resample, .threads = document.common.threads};
  const SceneView scene = make_volume_scene(
      input, load_seen_volume(input, document.volume, study.progress(), &resampling), document, 1.0);
  Report report = study.begin(input);
  report.scene.push_back(scene.subtitle + ".");
  for (const std::string& note : resampling.notes()) report.scene.push_back(note + ".");
  const VolumeQuality quality = run_volume_quality(*scene.volume, input.title(), effort, study.progress());
  report.sections = volume_quality_sections(quality);
  const PlacingSettings placing = placing_settings(*scene.volume->image, effort, document.common.seed);
  const std::vector<PlacingRow> placed = run_plane_placing(placing, study.progress());
  report.sections.push_back(plane_placing_section(placed, placing));
  report.stability = run_volume_extremes(*scene.volume, study.progress());
  append(run_extremes({ExtremeKind::kVolume, ExtremeKind::kLens, ExtremeKind::kCamera}, study.progress()),
         report.stability);
  append(plane_placing_cases(placed), report.stability);
  report.seconds = watch.seconds();
  return study.finish(report, figures_text(quality), quality.rows.size());
}

}  // namespace palpate
