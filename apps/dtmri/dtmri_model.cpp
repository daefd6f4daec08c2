#include "apps/dtmri/dtmri_model.h"

#include "common/app/cli/lens_text.h"
#include "common/app/cli/tensor_scene.h"

namespace palpate {

DtmriModel::DtmriModel(Options options, std::string program)
    : InputModel(std::move(options), std::move(program), FieldKind::kTensor) {}

DtmriContent DtmriModel::read(Input& input, const Options& options, Progress& progress) const {
  auto field = input.load_tensor(options.common.threads, &progress);
  progress.begin("colouring the voxels", 0);
  const auto voxels = make_tensor_voxels(field, input.title(), options.common.threads);
  SceneView view = make_tensor_scene(input, make_tensor_view(voxels, options.tensors), options, 1.0);
  auto info = std::make_shared<SceneInfo>(describe_open_input(input));
  info->bounds = view.bounds;
  info->outline = view.outline;
  info->anatomical = view.anatomical;
  SceneState state = begin_state(input, {});
  state.info = std::move(info);
  state.lens = direction_lens(options.volume, *view.volume->image);
  state.volume = std::move(view.volume);
  state.tensors = std::move(view.tensors);
  state.notes.insert(state.notes.end(), field->notes().lines.begin(), field->notes().lines.end());
  return std::make_shared<const SceneState>(std::move(state));
}

SceneState DtmriModel::present(Input& /*input*/, const DtmriContent& content, const Options& /*options*/,
                               const SceneSettings& settings, const SceneState* /*before*/,
                               Progress& /*progress*/) const {
  SceneState state = *content;
  state.settings = settings;
  return state;
}

void DtmriModel::describe_session(Session& session, const InputSpec& /*spec*/, const Options& options,
                                  const SceneSettings& /*settings*/, const SceneView& view) const {
  if (view.tensors) {
    add_option(session, "slices", slices_text(*view.tensors));
    add_option(session, "color", std::string(name_of(view.tensors->color)));
    add_option(session, "glyphs", std::string(name_of(view.tensors->glyphs)));
    add_option(session, "voxels", view.tensors->smooth ? "linear" : "nearest");
  }
  if (view.volume) {
    const VolumeView& volume = *view.volume;
    add_option(session, "volume", !volume.shown ? "none" : volume.colored ? "direction" : "fa");
    add_option(session, "transfer-function", options.volume.transfer);
    add_option(session, "focus-tf", options.volume.focus);
    add_option(session, "lens", lenses_text(volume.lenses));
    add_option(session, "samples", exact_number(volume.samples_per_voxel));
    add_option(session, "shading", volume.shading ? "on" : "off");
  }
  describe_camera(session, view);
}

}  // namespace palpate
