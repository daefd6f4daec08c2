#include "apps/grid/grid_model.h"

#include <utility>

#include "common/compose/lens_text.h"
#include "common/compose/volume_fields.h"

namespace palpate {

GridModel::GridModel(Options options, std::string program)
    : InputModel(std::move(options), std::move(program), FieldKind::kScalar) {}

TangibleVolume GridModel::read(Input& input, const Options& options, Progress& progress) const {
  TangibleVolume volume = load_tangible_volume(input, options.common.threads, &progress);
  input.set_beside(names_beside(input, options.volume));
  volume.beside = load_beside(input, options.volume, &progress);
  return volume;
}

void GridModel::begin(SceneSettings& settings, const Input& /*input*/, const Options& options) const {
  settings.transfer = options.volume.transfer;
  settings.focus = options.volume.focus;
}

SceneState GridModel::present(Input& input, const TangibleVolume& volume, const Options& options,
                              const SceneSettings& settings, const SceneState* before,
                              Progress& /*progress*/) const {
  Options with = options;
  with.volume.transfer = settings.transfer;
  with.volume.focus = settings.focus;
  SceneView view = make_volume_scene(input, volume, with, 1.0);
  auto info = std::make_shared<SceneInfo>(describe_open_input(input));
  info->bounds = view.bounds;
  info->outline = view.outline;
  info->anatomical = view.anatomical;
  SceneState state = begin_state(input, settings);
  state.info = std::move(info);
  state.looks = lens_looks(*view.volume, settings.focus, options.common.threads);
  if (has_regions(*view.volume)) state.notes.emplace_back(kRegionsNote);
  state.volume = std::move(view.volume);
  state.volume_label = settings.field;
  state.felt_scalar = volume.field;
  // Another time step of a field keeps its colours, or a film would flicker.
  const bool same_colors = before != nullptr && settings.field == before->settings.field &&
                           settings.transfer == before->settings.transfer;
  if (same_colors) {
    state.volume->transfer = before->volume->transfer;
    state.volume->regions = before->volume->regions;
  }
  return state;
}

void GridModel::describe_session(Session& session, const InputSpec& spec, const Options& /*options*/,
                                 const SceneSettings& settings, const SceneView& view) const {
  add_option(session, "raw-size", spec.raw.size);
  add_option(session, "raw-type", spec.raw.type);
  add_option(session, "raw-endian", spec.raw.endian);
  add_option(session, "raw-spacing", spec.raw.spacing);
  add_option(session, "raw-origin", spec.raw.origin);
  add_option(session, "raw-skip", spec.raw.skip);
  add_option(session, "transfer-function", settings.transfer);
  add_option(session, "focus-tf", settings.focus);
  if (view.volume) {
    describe_rays(session, *view.volume);
    describe_plane_images(session, *view.volume);
  }
  describe_projection(session, view);
  describe_camera(session, view);
}

}  // namespace palpate
