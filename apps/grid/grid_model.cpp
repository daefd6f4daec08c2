#include "apps/grid/grid_model.h"

#include <utility>

#include "common/compose/view_keep.h"
#include "common/compose/volume_fields.h"
#include "common/compose/volume_scene.h"

namespace palpate {

GridModel::GridModel(Document document, std::string program)
    : InputModel(std::move(document), std::move(program), FieldKind::kScalar) {}

GridContent GridModel::read(Input& input, const Document& document, Progress& progress) const {
  GridContent content;
  content.resampling = {.asked = document.volume.resample,
                        .otherwise = "128",  // a window is opened to see something
                        .threads = document.common.threads};
  content.volume = load_tangible_volume(input, document.common.threads, &progress, &content.resampling);
  input.set_secondary(secondary_names(input, document.volume));
  content.volume.secondary = load_secondary(input, document.volume, &progress, &content.resampling);
  return content;
}

SceneState GridModel::present(Input& input, const GridContent& content, const Document& document,
                              const SceneState* before, Progress& /*progress*/) const {
  const TangibleVolume& volume = content.volume;
  Document seen = document;
  // Another field has a window of its own, unless that was changed with it.
  if (before != nullptr && document.input.field != before->document.input.field &&
      document.volume.window == before->document.volume.window &&
      document.volume.level == before->document.volume.level) {
    seen.volume.window.reset();
    seen.volume.level.reset();
  }
  SceneView view = make_volume_scene(input, volume, seen, 1.0);
  auto info = std::make_shared<SceneInfo>(describe_open_input(input));
  info->bounds = view.bounds;
  info->outline = view.outline;
  info->anatomical = view.anatomical;
  SceneState state = begin_state(input, document);
  state.document.volume.resample = content.resampling.asked;
  state.volume_notes = content.resampling.notes();
  state.info = std::move(info);
  state.appearances = lens_appearances(*view.volume, document.volume.focus, document.common.threads);
  if (has_regions(*view.volume)) state.notes.emplace_back(kRegionsNote);
  if (const std::string note = color_note(*view.volume->image); !note.empty()) state.notes.push_back(note);
  state.volume = std::move(view.volume);
  state.volume_label = document.input.field;
  state.haptic_scalar = volume.field;
  // Another time step of a field keeps its colours, or a film would flicker.
  const bool same_colors = before != nullptr && document.input.field == before->document.input.field &&
                           document.volume.transfer == before->document.volume.transfer;
  if (same_colors) {
    state.volume->transfer = before->volume->transfer;
    state.volume->regions = before->volume->regions;
  }
  return state;
}

void GridModel::keep(const SceneView& view, Document& document) const {
  keep_camera(view, document);
  keep_appearance(view, document);
  if (view.volume) keep_volume(*view.volume, document);
}

}  // namespace palpate
