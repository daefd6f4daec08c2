#include "apps/dtmri/dtmri_model.h"

#include <filesystem>

#include "common/app/cli/line_view.h"
#include "common/app/cli/session_of.h"
#include "common/app/cli/tensor_scene.h"
#include "common/app/cli/verbs.h"
#include "common/base/text.h"

namespace palpate {
namespace {

std::shared_ptr<const SceneInfo> info_of(const Input& input, const SceneView& view) {
  auto info = std::make_shared<SceneInfo>();
  info->name = input.title();
  for (const auto& path : input.spec().files) info->files.files.push_back(std::filesystem::absolute(path));
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

DtmriModel::DtmriModel(Options options, std::string program)
    : options_(std::move(options)), program_(std::move(program)) {}

SceneState DtmriModel::read(Input& input, const Options& options, const SceneSettings& settings,
                            Progress& progress) {
  auto field = input.load_tensor(options.common.threads, &progress);
  progress.begin("colouring the voxels", 0);
  const auto voxels = make_tensor_voxels(field, input.title(), options.common.threads);
  SceneView view = make_tensor_scene(input, make_tensor_view(voxels, options.tensors), options, 1.0);
  SceneState state;
  state.info = info_of(input, view);
  state.settings = settings;
  state.lines = std::make_shared<const std::vector<Line>>();
  state.tensors = std::move(view.tensors);
  state.notes = input.notes();
  state.notes.insert(state.notes.end(), field->notes().lines.begin(), field->notes().lines.end());
  state.seconds_load = input.seconds_open() + input.seconds_read() + input.seconds_field();
  return state;
}

SceneState DtmriModel::show(const Options& options, Progress& progress) {
  progress.begin("opening", 0);
  Input input = Input::open(input_spec(options.input, FieldKind::kTensor), &progress);
  SceneSettings settings;
  settings.field = input.field_label();
  settings.time_step = input.time().step;
  SceneState state = read(input, options, settings, progress);
  scene_ = Scene{std::move(input), state};
  return state;
}

SceneState DtmriModel::start(Progress& progress) { return show(options_, progress); }

SceneState DtmriModel::open(const InputFiles& files, Progress& progress) {
  // A new input starts afresh: fields, times and places of the old one mean nothing to it.
  Options options;
  options.common = options_.common;
  options.input.files = files.files;
  options.input.solution = files.solution;
  SceneState state = show(options, progress);
  options_ = std::move(options);
  return state;
}

SceneState DtmriModel::update(const SceneSettings& settings, Progress& progress) {
  Scene& scene = *scene_;
  const SceneSettings before = scene.shown.settings;
  if (settings.field == before.field && settings.time_step == before.time_step) {
    scene.shown.settings = settings;
    return scene.shown;
  }
  try {
    scene.input.set_field(settings.field);
    scene.input.set_time_step(settings.time_step);
    scene.shown = read(scene.input, options_, settings, progress);
  } catch (...) {
    scene.input.set_field(before.field);
    scene.input.set_time_step(before.time_step);
    throw;
  }
  return scene.shown;
}

std::string DtmriModel::save_session(const SceneSettings& settings, const SceneView& view,
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
  if (view.tensors) {
    add("slices", slices_text(*view.tensors));
    add("color", std::string(name_of(view.tensors->color)));
    add("glyphs", std::string(name_of(view.tensors->glyphs)));
    add("voxels", view.tensors->smooth ? "linear" : "nearest");
  }
  add("projection", view.camera.projection == Projection::kOrthographic ? "orthographic" : "perspective");
  add("camera", camera_text(view.camera, view.bounds, kSessionAspect));
  for (const auto& [option, value] : touch) add(option.c_str(), value);
  return store_session(session, spec);
}

}  // namespace palpate
