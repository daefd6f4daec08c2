#include "apps/dtmri/dtmri_model.h"

#include "common/app/cli/lens_text.h"
#include "common/app/cli/tensor_scene.h"
#include "common/app/cli/view_tracts.h"

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
  if (!options.tract_look.file.empty()) {
    const ViewTracts read = read_view_tracts(options.tract_look, &progress);
    if (!read.left_out.empty()) state.notes.push_back(read.left_out);
    state.tracts = TractView{
        .bundle = read.bundle, .width = options.tract_look.width, .opacity = options.tract_look.opacity};
  }
  return std::make_shared<const SceneState>(std::move(state));
}

SceneState DtmriModel::present(Input& /*input*/, const DtmriContent& content, const Options& options,
                               const SceneSettings& settings, const SceneState* before,
                               Progress& progress) const {
  SceneState state = *content;
  state.settings = settings;
  if (settings.seeds.empty()) return state;
  const bool same = before != nullptr && same_content(settings, before->settings) &&
                    settings.seeds == before->settings.seeds && settings.cutoff == before->settings.cutoff &&
                    settings.seeds_per_voxel == before->settings.seeds_per_voxel;
  if (same) {
    state.tracts = before->tracts;
    state.seeds = before->seeds;
    state.seconds_trace = before->seconds_trace;
    return state;
  }
  TractTracingOptions wanted = options.tracts;
  wanted.seeds = settings.seeds;
  wanted.seeds_per_voxel = settings.seeds_per_voxel;
  wanted.cutoff = settings.cutoff;
  const ViewTracts traced = trace_view_tracts(wanted, options.common, *state.tensors->image, &progress);
  state.tracts = TractView{
      .bundle = traced.bundle, .width = options.tract_look.width, .opacity = options.tract_look.opacity};
  state.seeds = traced.seeds;
  state.seconds_trace = traced.seconds;
  if (traced.bundle->order.empty()) state.notes.push_back("no tract: " + traced.why_none);
  if (!traced.left_out.empty()) state.notes.push_back(traced.left_out);
  return state;
}

void DtmriModel::begin(SceneSettings& settings, const Input& /*input*/, const Options& options) const {
  settings.seeds = options.tracts.seeds;
  settings.seeds_per_voxel = options.tracts.seeds_per_voxel;
  settings.cutoff = options.tracts.cutoff;
}

void DtmriModel::describe_session(Session& session, const InputSpec& /*spec*/, const Options& options,
                                  const SceneSettings& settings, const SceneView& view) const {
  if (!options.tract_look.file.empty())
    add_option(session, "tracts", std::filesystem::absolute(options.tract_look.file).string());
  if (!settings.seeds.empty()) {
    add_option(session, "seeds", settings.seeds);
    add_option(session, "seeds-per-voxel", std::to_string(settings.seeds_per_voxel));
    add_option(session, "cutoff", exact_number(settings.cutoff));
    if (view.tracts) {
      add_option(session, "tract-width", exact_number(view.tracts->width));
      add_option(session, "tract-opacity", exact_number(view.tracts->opacity));
    }
  }
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
    add_option(session, "lens", lenses_text(volume));
    add_option(session, "samples", exact_number(volume.samples_per_voxel));
    add_option(session, "shading", volume.shading ? "on" : "off");
  }
  describe_camera(session, view);
}

}  // namespace palpate
