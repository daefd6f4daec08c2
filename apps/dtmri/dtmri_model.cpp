#include "apps/dtmri/dtmri_model.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "apps/dtmri/tensor_scene.h"
#include "apps/dtmri/underlay.h"
#include "apps/dtmri/view_tracts.h"
#include "common/base/error.h"
#include "common/compose/lens_text.h"
#include "common/field/color_transfer_file.h"
#include "common/field/region_transfer_file.h"

namespace palpate {
namespace {

std::shared_ptr<const SceneInfo> info_of(const Input& input, const SceneView& view) {
  SceneInfo info = describe_open_input(input);
  info.bounds = view.bounds;
  info.outline = view.outline;
  info.anatomical = view.anatomical;
  return std::make_shared<const SceneInfo>(std::move(info));
}

/// Tracts of a file, or traced from seeds: those of `before` where the settings are the same.
void show_tracts(const Options& options, const SceneSettings& settings, const SceneState* before,
                 Progress& progress, SceneState& state) {
  const auto show = [&](const std::shared_ptr<const TractBundle>& bundle) {
    state.tracts =
        TractView{.bundle = bundle, .width = options.tract_look.width, .opacity = options.tract_look.opacity};
  };
  const bool same = before != nullptr && before->tracts && settings.field == before->settings.field &&
                    settings.time_step == before->settings.time_step &&
                    settings.tracts == before->settings.tracts && settings.seeds == before->settings.seeds &&
                    settings.cutoff == before->settings.cutoff &&
                    settings.seeds_per_voxel == before->settings.seeds_per_voxel;
  if (settings.seeds.empty() && settings.tracts.empty()) return;
  if (same) {
    state.tracts = before->tracts;
    state.seeds = before->seeds;
    state.seconds_trace = before->seconds_trace;
  } else if (settings.seeds.empty()) {
    const ViewTracts read = read_view_tracts({.file = settings.tracts}, &progress);
    show(read.bundle);
    if (!read.left_out.empty()) state.notes.push_back(read.left_out);
  } else if (!state.tensors) {
    throw usage_error("there are no tensors to trace tracts through");
  } else {
    TractTracingOptions wanted = options.tracts;
    wanted.seeds = settings.seeds;
    wanted.seeds_per_voxel = settings.seeds_per_voxel;
    wanted.cutoff = settings.cutoff;
    const ViewTracts traced = trace_view_tracts(wanted, options.common, *state.tensors->image, &progress);
    show(traced.bundle);
    state.seeds = traced.seeds;
    state.seconds_trace = traced.seconds;
    if (traced.bundle->order.empty()) state.notes.push_back("no tract: " + traced.why_none);
    if (!traced.left_out.empty()) state.notes.push_back(traced.left_out);
  }
}

}  // namespace

DtmriModel::DtmriModel(Options options, std::string program)
    : InputModel(std::move(options), std::move(program), FieldKind::kTensor) {}

DtmriContent DtmriModel::read(Input& input, const Options& options, Progress& progress) const {
  if (role_of(input) != FileRole::kTensors || input.fields().empty()) {
    (void)with_input_role(options, input);  // refuses what cannot be shown
    SceneState state = begin_state(input, {});
    state.info = std::make_shared<const SceneInfo>(describe_open_input(input));
    return std::make_shared<const SceneState>(std::move(state));
  }
  auto field = input.load_tensor(options.common.threads, &progress);
  progress.begin("colouring the voxels", 0);
  const auto voxels = make_tensor_voxels(field, input.title(), options.common.threads);
  SceneView view = make_tensor_scene(
      input, {.tensors = make_tensor_view(voxels, options.tensors), .tracts = {}}, options, 1.0);
  SceneState state = begin_state(input, {});
  state.info = info_of(input, view);
  state.looks = {direction_lens(options.volume, *view.volume->image)};
  state.volume = std::move(view.volume);
  state.volume_label = view.volume_label;
  state.tensors = std::move(view.tensors);
  state.notes.insert(state.notes.end(), field->notes().lines.begin(), field->notes().lines.end());
  return std::make_shared<const SceneState>(std::move(state));
}

SceneState DtmriModel::present(Input& input, const DtmriContent& content, const Options& options,
                               const SceneSettings& settings, const SceneState* before,
                               Progress& progress) const {
  SceneState state = *content;
  state.settings = settings;
  show_tracts(options, settings, before, progress, state);
  if (!settings.underlay.empty()) {
    const bool read = before != nullptr && before->settings.underlay == settings.underlay && before->tensors;
    // Its own numbers are for the image that they were given with.
    Options with = options;
    if (settings.underlay != options.tensors.underlay) with.tensors.window = with.tensors.level = {};
    Underlay underlay;
    if (read) {
      underlay.image = before->tensors->underlay->image;
    } else {
      underlay = load_underlay(settings.underlay, &progress);
    }
    for (std::string& note : show_underlay(underlay, with, state.tensors))
      state.notes.push_back(std::move(note));
  }
  if (content->tensors) return state;
  // Where there are no tensors, the scene is as large as what is shown in their place.
  const SceneView view =
      make_tensor_scene(input, {.tensors = state.tensors, .tracts = state.tracts}, options, 1.0);
  state.info = info_of(input, view);
  return state;
}

std::optional<SceneSettings> DtmriModel::join(const InputFiles& files, const SceneSettings& now,
                                              Progress& progress) const {
  if (files.files.size() != 1 || files.solution) return std::nullopt;
  InputSpec spec{.files = files.files};
  spec.kind = FieldKind::kTensor;
  const Input input = Input::open(spec, &progress);
  SceneSettings with = now;
  switch (role_of(input)) {
    case FileRole::kTracts:
      with.tracts = files.files.front().string();
      with.seeds.clear();
      return with;
    case FileRole::kScalar:
      with.underlay = files.files.front().string();
      return with;
    case FileRole::kTensors:
      break;
  }
  return std::nullopt;
}

void DtmriModel::begin(SceneSettings& settings, const Input& input, const Options& given) const {
  const Options options = with_input_role(given, input);
  settings.tracts = options.tract_look.file;
  settings.underlay = options.tensors.underlay;
  settings.seeds = options.tracts.seeds;
  settings.seeds_per_voxel = options.tracts.seeds_per_voxel;
  settings.cutoff = options.tracts.cutoff;
}

void DtmriModel::describe_session(Session& session, const InputSpec& spec, const Options& options,
                                  const SceneSettings& settings, const SceneView& view) const {
  // An input that is one of these itself is named as such.
  const auto add_file = [&](const char* name, const std::string& file) {
    if (!file.empty() && (spec.files.empty() || file != spec.files.front().string()))
      add_option(session, name, std::filesystem::absolute(file).string());
  };
  add_file("tracts", settings.tracts);
  add_file("underlay", settings.underlay);
  if (view.tensors && view.tensors->underlay) {
    const UnderlayView& underlay = *view.tensors->underlay;
    add_option(session, "blend", std::string(name_of(underlay.blend)));
    add_option(session, "window", exact_number(underlay.window.width));
    add_option(session, "level", exact_number(underlay.window.level));
  }
  if (!settings.seeds.empty()) {
    add_option(session, "seeds", settings.seeds);
    add_option(session, "seeds-per-voxel", std::to_string(settings.seeds_per_voxel));
    add_option(session, "cutoff", exact_number(settings.cutoff));
  }
  if (view.tracts) {
    add_option(session, "tract-width", exact_number(view.tracts->width));
    add_option(session, "tract-opacity", exact_number(view.tracts->opacity));
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
    add_option(session, "transfer-function",
               volume.regions ? region_words(*volume.regions) : transfer_words(volume.transfer));
    const auto lens = std::find_if(volume.lenses.begin(), volume.lenses.end(),
                                   [](const Lens& one) { return (one.transfer || one.regions) && !one.cut; });
    add_option(session, "focus-tf",
               lens == volume.lenses.end() ? options.volume.focus
               : lens->regions             ? region_words(*lens->regions)
                                           : transfer_words(*lens->transfer));
    describe_rays(session, volume);
  }
  describe_projection(session, view);
  describe_camera(session, view);
}

}  // namespace palpate
