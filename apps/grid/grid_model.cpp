#include "apps/grid/grid_model.h"

#include <utility>

#include "common/app/cli/line_view.h"
#include "common/app/cli/session_of.h"
#include "common/app/cli/verbs.h"
#include "common/base/text.h"

namespace palpate {
namespace {

std::shared_ptr<const SceneInfo> describe_input_of(const Input& input, const SceneView& view) {
  auto info = std::make_shared<SceneInfo>();
  info->name = input.title();
  info->files = {input.spec().files, input.spec().solution};
  if (const FileInfo* file = input.file()) {
    info->facts.push_back(file->format);
    info->times = file->times;
  }
  info->fields = input.fields();
  info->bounds = view.bounds;
  info->outline = view.outline;
  info->anatomical = view.anatomical;
  return info;
}

}  // namespace

GridModel::GridModel(Options options, std::string program)
    : options_(std::move(options)), program_(std::move(program)) {}

SceneState GridModel::describe(const Input& input, const Options& options, const SceneSettings& settings,
                               const TangibleVolume& volume) {
  Options with = options;
  with.volume.transfer = settings.transfer;
  SceneView view = make_volume_scene(input, volume.image, with, 1.0);
  SceneState state;
  state.info = describe_input_of(input, view);
  state.settings = settings;
  state.lines = std::make_shared<const std::vector<Line>>();
  state.volume = std::move(view.volume);
  state.felt_scalar = volume.field;
  state.notes = input.notes();
  state.seconds_load = input.seconds_open() + input.seconds_read() + input.seconds_field();
  return state;
}

SceneState GridModel::show(const Options& options, Progress& progress) {
  progress.begin("opening", 0);
  Input input = Input::open(input_spec(options.input, FieldKind::kScalar), &progress);
  TangibleVolume volume = load_tangible_volume(input, options.common.threads, &progress);
  SceneSettings settings;
  settings.field = input.field_label();
  settings.time_step = input.time().step;
  settings.transfer = options.volume.transfer;
  SceneState state = describe(input, options, settings, volume);
  scene_ = Scene{std::move(input), std::move(volume), state};
  return state;
}

SceneState GridModel::start(Progress& progress) { return show(options_, progress); }

SceneState GridModel::open(const InputFiles& files, Progress& progress) {
  // A new input starts afresh: fields, times and colours of the old one mean nothing to it.
  Options options;
  options.common = options_.common;
  options.input.files = files.files;
  options.input.solution = files.solution;
  SceneState state = show(options, progress);
  options_ = std::move(options);
  return state;
}

SceneState GridModel::update(const SceneSettings& settings, Progress& progress) {
  Scene& scene = *scene_;
  const SceneSettings& before = scene.shown.settings;
  TangibleVolume volume = scene.volume;
  if (settings.field != before.field || settings.time_step != before.time_step) {
    try {
      scene.input.set_field(settings.field);
      scene.input.set_time_step(settings.time_step);
      volume = load_tangible_volume(scene.input, options_.common.threads, &progress);
    } catch (...) {
      scene.input.set_field(before.field);
      scene.input.set_time_step(before.time_step);
      throw;
    }
  }
  SceneState state = describe(scene.input, options_, settings, volume);
  // Another time step of a field keeps its colours, or a film would flicker.
  const bool same_colors = settings.field == before.field && settings.transfer == before.transfer;
  if (same_colors) state.volume->transfer = scene.shown.volume->transfer;
  scene.volume = std::move(volume);
  scene.shown = state;
  return state;
}

std::string GridModel::save_session(const SceneSettings& settings, const SceneView& view,
                                    const std::vector<std::pair<std::string, std::string>>& touch) {
  const InputSpec& spec = scene_->input.spec();
  Session session = begin_session(spec, program_);
  const auto add = [&session](const char* name, const std::string& value) {
    if (!value.empty()) session.options.emplace_back(name, value);
  };
  add("example", spec.example);
  add("field", settings.field);
  const auto& times = scene_->input.times();
  if (times.size() > 1) add("time", exact_number(times[settings.time_step]));
  add("raw-size", spec.raw.size);
  add("raw-type", spec.raw.type);
  add("raw-endian", spec.raw.endian);
  add("raw-spacing", spec.raw.spacing);
  add("raw-origin", spec.raw.origin);
  add("raw-skip", spec.raw.skip);
  add("transfer-function", settings.transfer);
  if (view.volume) {
    add("samples", exact_number(view.volume->samples_per_voxel));
    add("shading", view.volume->shading ? "on" : "off");
  }
  add("projection", view.camera.projection == Projection::kOrthographic ? "orthographic" : "perspective");
  add("camera", camera_text(view.camera, view.bounds, kSessionAspect));
  for (const auto& [option, value] : touch) add(option.c_str(), value);
  return store_session(session, spec);
}

}  // namespace palpate
