#include "apps/flow/flow_model.h"

#include "common/app/cli/domain_outline.h"
#include "common/app/cli/felt_scalar.h"
#include "common/app/cli/line_color.h"
#include "common/app/cli/line_view.h"
#include "common/app/cli/session_of.h"
#include "common/app/cli/verbs.h"
#include "common/base/error.h"
#include "common/base/text.h"
#include "common/field/grid/box_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/scene/seeds.h"
#include "common/scene/session.h"

namespace palpate {
namespace {

std::string grid_fact(const VectorField& field) {
  if (const TetMesh* mesh = field.tet_mesh()) {
    return std::to_string(mesh->points().size()) + " points, " + std::to_string(mesh->cells().size()) +
           " tetrahedra";
  }
  if (const BoxGrid* grid = field.box_grid()) {
    const Index3 n = grid->points();
    return std::to_string(n.x) + " x " + std::to_string(n.y) + " x " + std::to_string(n.z) + " points";
  }
  return "a formula, exact everywhere";
}

std::shared_ptr<const SceneInfo> describe(const Input& input, const VectorField& field) {
  auto info = std::make_shared<SceneInfo>();
  info->name = input.title();
  if (const FileInfo* file = input.file()) {
    for (const auto& path : input.spec().files) info->files.files.push_back(std::filesystem::absolute(path));
    if (input.spec().solution) info->files.solution = std::filesystem::absolute(*input.spec().solution);
    info->facts.push_back(file->format);
    info->fields = input.fields();
    info->times = file->times;
  } else {
    info->fields.push_back(field.name());
  }
  info->facts.push_back(grid_fact(field));
  info->facts.push_back("speed up to " + short_number(field.max_speed()));
  for (const auto integrator : {Integrator::kExact, Integrator::kEuler, Integrator::kRk4, Integrator::kBs32,
                                Integrator::kRk34, Integrator::kDp54, Integrator::kRodas4}) {
    if (integrator == Integrator::kExact && !field.tet_mesh()) continue;
    info->integrators.emplace_back(name_of(integrator));
  }
  info->color_arrays = color_arrays(input);
  info->bounds = field.bounds();
  info->outline = domain_outline(field);
  return info;
}

/// The settings as options: one grammar for the panel and the command line.
Options with_settings(Options options, const SceneSettings& settings) {
  options.input.field = settings.field;
  options.tracing.integrator = settings.integrator;
  options.tracing.seeds = settings.seeds;
  options.tracing.direction = settings.direction;
  options.tracing.tolerance = settings.tolerance;
  options.tracing.step = settings.step;
  options.tracing.max_length = settings.max_length;
  options.common.seed = settings.random_seed;
  return options;
}

SceneSettings settings_of(const Options& options, const std::string& field, std::size_t time_step) {
  const TracingOptions& tracing = options.tracing;
  return {.field = field,
          .time_step = time_step,
          .integrator = tracing.integrator,
          .seeds = tracing.seeds.empty() ? kViewSeeds : tracing.seeds,
          .direction = tracing.direction.empty() ? "both" : tracing.direction,
          .tolerance = tracing.tolerance,
          .step = tracing.step,
          .max_length = tracing.max_length,
          .random_seed = options.common.seed};
}

}  // namespace

FlowModel::FlowModel(Options options, std::string program)
    : options_(std::move(options)), program_(std::move(program)) {}

FlowModel::Scene FlowModel::load(const Options& options, Progress& progress) {
  progress.begin("opening", 0);
  Input input = Input::open(input_spec(options.input), &progress);
  auto field = input.load_field(options.common.threads, &progress);
  auto info = describe(input, *field);
  std::string label = input.field_label();
  const std::size_t time_step = input.time().step;
  Scene scene{std::move(input), std::move(field), std::move(info), std::move(label), time_step};
  choose_felt(scene, options, progress);
  return scene;
}

void FlowModel::choose_felt(Scene& scene, const Options& options, Progress& progress) {
  if (options.touch.scalar.empty()) return;
  scene.felt = felt_scalar(options.touch.scalar, scene.input, scene.field, options.common.threads, &progress);
}

SceneState FlowModel::trace(const Scene& scene, const Options& options, const SceneSettings& settings,
                            Progress& progress) {
  const VectorField& field = *scene.field;
  const auto seeds = make_seeds(parse_seeds(settings.seeds), field, settings.random_seed);
  const TraceOptions trace = view_trace_options(with_settings(options, settings), field);
  TraceResult result = trace_lines(field, seeds, trace, &progress);
  SceneState state{
      .info = scene.info,
      .settings = settings,
      .lines = std::make_shared<const std::vector<Line>>(std::move(result.lines)),
      .probed = scene.field,
      .felt_scalar = scene.felt,
      .felt_scalar_key = scalar_key(options.touch.scalar),
      .ends = result.ends,
      .seeds = seeds.size(),
      .outside_seeds = result.outside_seeds.size(),
      .error_max = result.error_max,
      .seconds_load = scene.input.seconds_open() + scene.input.seconds_read() + scene.input.seconds_field(),
      .seconds_trace = result.seconds_prepare + result.seconds_trace};
  state.settings.integrator = name_of(result.integrator);
  state.settings.max_length = trace.max_length;
  if (const FileInfo* file = scene.input.file()) state.notes = file->notes;
  state.notes.insert(state.notes.end(), field.notes().lines.begin(), field.notes().lines.end());
  return state;
}

void FlowModel::color(Scene& scene, const Options& options, SceneState& state, Progress& progress) {
  state.color_array.reset();
  if (state.settings.color_array.empty()) return;
  const LineColor color = line_color(state.settings.color_array, scene.input);
  state.color_array =
      line_style(color, scene.input, *scene.field, *state.lines, options.common.threads, &progress).array;
}

SceneState FlowModel::show(Scene scene, const Options& options, const std::string& color_array,
                           Progress& progress) {
  SceneSettings settings = settings_of(options, scene.field_label, scene.time_step);
  settings.color_array = color_array;
  scene.shown = trace(scene, options, settings, progress);
  color(scene, options, scene.shown, progress);
  scene_ = std::move(scene);
  return scene_->shown;
}

SceneState FlowModel::start(Progress& progress) {
  Scene scene = load(options_, progress);
  const LineColor wanted = line_color(options_.view.color, scene.input);
  return show(std::move(scene), options_, wanted.by == ColorBy::kArray ? wanted.name : std::string(),
              progress);
}

SceneState FlowModel::open(const InputFiles& files, Progress& progress) {
  // A new input starts afresh: fields, seeds and lengths of the old one mean nothing to it.
  Options options;
  options.common = options_.common;
  options.input.files = files.files;
  options.input.solution = files.solution;
  SceneState state = show(load(options, progress), options, {}, progress);
  options_ = std::move(options);
  return state;
}

SceneState FlowModel::update(const SceneSettings& settings, Progress& progress) {
  Scene& scene = *scene_;
  if (settings.field != scene.field_label || settings.time_step != scene.time_step) {
    const std::string old_label = scene.field_label;
    const std::size_t old_step = scene.time_step;
    const auto old_field = scene.field;
    try {
      if (scene.input.file()) {
        scene.input.set_field(settings.field);
        scene.input.set_time_step(settings.time_step);
      }
      scene.field = scene.input.load_field(options_.common.threads, &progress);
      choose_felt(scene, options_, progress);
    } catch (...) {
      scene.field = old_field;
      scene.input.set_field(old_label);
      scene.input.set_time_step(old_step);
      throw;
    }
    scene.info = describe(scene.input, *scene.field);
    scene.field_label = settings.field;
    scene.time_step = settings.time_step;
  }
  // Another colour needs no other lines.
  SceneSettings without_color = settings;
  without_color.color_array = scene.shown.settings.color_array;
  SceneState state = scene.shown;
  if (without_color == scene.shown.settings) {
    state.settings = settings;
  } else {
    state = trace(scene, options_, settings, progress);
  }
  color(scene, options_, state, progress);
  scene.shown = state;
  return state;
}

std::vector<MeasuredCost> FlowModel::costs() const {
  if (!scene_) return {};
  std::vector<MeasuredCost> costs = measured_costs(scene_->input, scene_->field->tet_mesh());
  costs.push_back({.what = "lines", .milliseconds = 1e3 * scene_->shown.seconds_trace});
  return costs;
}

std::string FlowModel::save_session(const SceneSettings& settings, const SceneView& view,
                                    const std::vector<std::pair<std::string, std::string>>& touch) {
  const Scene& scene = *scene_;
  const InputSpec& spec = scene.input.spec();
  Session session = begin_session(spec, program_);
  const auto add = [&session](const char* name, const std::string& value) {
    if (!value.empty()) session.options.emplace_back(name, value);
  };
  add("example", spec.example);
  add("field", scene.field_label);
  const auto& times = scene.input.times();
  if (times.size() > 1) add("time", exact_number(times[settings.time_step]));
  add("seeds", settings.seeds);
  add("seed", std::to_string(settings.random_seed));
  add("direction", settings.direction);
  add("integrator", settings.integrator);
  add("tolerance", exact_number(settings.tolerance));
  if (settings.step > 0.0) add("step", exact_number(settings.step));
  if (settings.max_length > 0.0) add("max-length", exact_number(settings.max_length));
  add("camera", camera_text(view.camera, view.bounds, kSessionAspect));
  add("color",
      settings.color_array.empty() ? std::string(name_of(view.style.color_by)) : settings.color_array);

  add("scalar", options_.touch.scalar);
  for (const auto& [option, value] : touch) add(option.c_str(), value);

  return store_session(session, spec);
}

}  // namespace palpate
