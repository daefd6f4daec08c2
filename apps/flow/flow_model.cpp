#include "apps/flow/flow_model.h"

#include "common/base/number_text.h"
#include "common/compose/domain_outline.h"
#include "common/compose/felt_scalar.h"
#include "common/compose/line_color.h"
#include "common/compose/line_view.h"
#include "common/compose/resampled_volume.h"
#include "common/compose/volume_fields.h"
#include "common/field/grid/box_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/scene/plan.h"
#include "common/scene/seeds.h"

namespace palpate {
namespace {

/// As `--volume` has them.
std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ",") + name;
  return text;
}

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
  auto info = std::make_shared<SceneInfo>(describe_open_input(input));
  if (!input.file()) info->fields = {field.name()};
  info->facts.push_back(grid_fact(field));
  info->facts.push_back("speed up to " + short_number(field.max_speed()));
  for (const auto integrator : {Integrator::kExact, Integrator::kEuler, Integrator::kRk4, Integrator::kBs32,
                                Integrator::kRk34, Integrator::kDp54, Integrator::kRodas4}) {
    if (integrator == Integrator::kExact && !field.tet_mesh()) continue;
    info->integrators.emplace_back(name_of(integrator));
  }
  info->color_arrays = color_arrays(input);
  info->volumes = flow_scalars(input);
  info->resampled = needs_resampling(field);
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

/// The lines of `content` under `settings`, not coloured yet.
SceneState trace(const Input& input, const FlowContent& content, const Options& options,
                 const SceneSettings& settings, Progress& progress) {
  const VectorField& field = *content.field;
  const auto seeds = make_seeds(parse_seeds(settings.seeds), field, settings.random_seed);
  const TraceOptions trace = view_trace_options(with_settings(options, settings), field);
  TraceResult result = trace_lines(field, seeds, trace, &progress);
  SceneState state = begin_state(input, settings);
  state.info = content.info;
  state.lines = std::make_shared<const std::vector<Line>>(std::move(result.lines));
  state.probed = content.field;
  state.felt_scalar = content.felt;
  state.felt_scalar_key = scalar_key(options.touch.scalar);
  state.ends = result.ends;
  state.seeds = seeds.size();
  state.outside_seeds = result.outside_seeds.size();
  state.error_max = result.error_max;
  state.seconds_trace = result.seconds_prepare + result.seconds_trace;
  state.settings.integrator = name_of(result.integrator);
  state.settings.max_length = trace.max_length;
  state.notes.insert(state.notes.end(), field.notes().lines.begin(), field.notes().lines.end());
  return state;
}

/// Samples settings.color_array along the lines of `state`.
void color(Input& input, const FlowContent& content, const Options& options, SceneState& state,
           Progress& progress) {
  state.color_array.reset();
  if (state.settings.color_array.empty()) return;
  const LineColor color = line_color(state.settings.color_array, input);
  state.color_array =
      line_style(color, input, *content.field, *state.lines, options.common.threads, &progress).array;
}

/// The volume around the lines, as `settings` name it: the voxels of `before` where these are the same.
void show_volume(Input& input, const FlowContent& content, const Options& options, const SceneState* before,
                 SceneState& state, Progress& progress) {
  const SceneSettings& settings = state.settings;
  state.volume_notes.clear();
  state.looks.clear();
  state.volume.reset();
  if (settings.volumes.empty()) return;
  Options with = options;
  with.volume.transfer = settings.transfer;
  with.volume.focus = settings.focus;
  with.volume.resample = settings.resample;
  with.volume.scalar = joined(settings.volumes);
  check_flow_volume(with.volume);
  const std::vector<std::string> names = flow_volume_names(input, with.volume);
  const bool same = before != nullptr && before->volume && before->settings.volumes == settings.volumes &&
                    before->settings.resample == settings.resample &&
                    before->settings.field == settings.field &&
                    before->settings.time_step == settings.time_step;
  TangibleVolume voxels;
  if (same) {
    voxels.image = before->volume->image;
    voxels.beside = before->volume->fields;
    state.volume_notes = before->volume_notes;
  } else {
    FlowVolume volume =
        load_flow_volume(input, content.field, names, settings.resample, options.common.threads, &progress);
    voxels = std::move(volume.voxels);
    for (const TakenScalar& taken : volume.taken) state.volume_notes.push_back(taken_text(taken));
  }
  VolumeView view = make_volume_view(voxels, with);
  if (has_regions(view)) state.volume_notes.emplace_back(kRegionsNote);
  // Another time step keeps its colours, or a film would flicker.
  if (before != nullptr && before->volume && before->settings.volumes.front() == settings.volumes.front() &&
      before->settings.transfer == settings.transfer) {
    view.transfer = before->volume->transfer;
    view.regions = before->volume->regions;
  }
  state.looks = lens_looks(view, settings.focus, options.common.threads);
  state.volume_label = names.front();
  state.volume = std::move(view);
}

/// Whether both ask for the same lines, whatever is around them and whatever colours them.
bool same_lines(const SceneSettings& a, SceneSettings b) {
  b.color_array = a.color_array;
  b.volumes = a.volumes;
  b.resample = a.resample;
  b.transfer = a.transfer;
  b.focus = a.focus;
  return a == b;
}

}  // namespace

FlowModel::FlowModel(Options options, std::string program)
    : InputModel(std::move(options), std::move(program), FieldKind::kVector) {}

FlowContent FlowModel::read(Input& input, const Options& options, Progress& progress) const {
  FlowContent content;
  content.field = input.load_field(options.common.threads, &progress);
  content.info = describe(input, *content.field);
  if (!options.touch.scalar.empty()) {
    content.felt = felt_scalar(options.touch.scalar, input, content.field, options.common.threads, &progress);
  }
  return content;
}

void FlowModel::begin(SceneSettings& settings, const Input& input, const Options& options) const {
  const TracingOptions& tracing = options.tracing;
  settings.integrator = tracing.integrator;
  settings.seeds = tracing.seeds.empty() ? kViewSeeds : tracing.seeds;
  settings.direction = tracing.direction.empty() ? "both" : tracing.direction;
  settings.tolerance = tracing.tolerance;
  settings.step = tracing.step;
  settings.max_length = tracing.max_length;
  settings.random_seed = options.common.seed;
  if (!options.volume.scalar.empty()) {
    for (const std::string_view name : split(options.volume.scalar, ',')) settings.volumes.emplace_back(name);
  }
  settings.resample = options.volume.resample;
  settings.transfer = options.volume.transfer;
  settings.focus = options.volume.focus;
  const LineColor wanted = line_color(options.view.color, input);
  if (wanted.by == ColorBy::kArray) settings.color_array = wanted.name;
}

SceneState FlowModel::present(Input& input, const FlowContent& content, const Options& options,
                              const SceneSettings& settings, const SceneState* before,
                              Progress& progress) const {
  const bool keeps_lines = before != nullptr && same_lines(settings, before->settings);
  SceneState state = keeps_lines ? *before : trace(input, content, options, settings, progress);
  if (keeps_lines) state.settings = settings;
  color(input, content, options, state, progress);
  show_volume(input, content, options, before, state, progress);
  return state;
}

std::string FlowModel::measured() const {
  const Scene* const open = scene();
  if (open == nullptr) return {};
  std::vector<MeasuredCost> costs = measured_costs(open->input, open->content.field->tet_mesh());
  costs.push_back({.what = "lines", .milliseconds = 1e3 * open->shown.seconds_trace});
  return measured_text(costs);
}

void FlowModel::describe_session(Session& session, const InputSpec& /*spec*/, const Options& options,
                                 const SceneSettings& settings, const SceneView& view) const {
  add_option(session, "seeds", settings.seeds);
  add_option(session, "seed", std::to_string(settings.random_seed));
  add_option(session, "direction", settings.direction);
  add_option(session, "integrator", settings.integrator);
  add_option(session, "tolerance", exact_number(settings.tolerance));
  if (settings.step > 0.0) add_option(session, "step", exact_number(settings.step));
  if (settings.max_length > 0.0) add_option(session, "max-length", exact_number(settings.max_length));
  if (!settings.volumes.empty() && view.volume) {
    add_option(session, "volume", joined(settings.volumes));
    add_option(session, "resample", settings.resample);
    add_option(session, "transfer-function", settings.transfer);
    add_option(session, "focus-tf", settings.focus);
    describe_rays(session, *view.volume);
    describe_plane_images(session, *view.volume);
  }
  describe_projection(session, view);
  describe_camera(session, view);
  add_option(session, "color",
             settings.color_array.empty() ? std::string(name_of(view.style.color_by)) : settings.color_array);
  const LineStyle usual;
  if (view.style.width != usual.width) add_option(session, "line-width", exact_number(view.style.width));
  if (view.style.opacity != usual.opacity)
    add_option(session, "line-opacity", exact_number(view.style.opacity));
  add_option(session, "scalar", options.touch.scalar);
}

}  // namespace palpate
