#include "apps/flow/flow_model.h"

#include "common/app/cli/domain_outline.h"
#include "common/app/cli/felt_scalar.h"
#include "common/app/cli/line_color.h"
#include "common/app/cli/line_view.h"
#include "common/field/grid/box_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/scene/plan.h"
#include "common/scene/seeds.h"

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
  const LineColor wanted = line_color(options.view.color, input);
  if (wanted.by == ColorBy::kArray) settings.color_array = wanted.name;
}

SceneState FlowModel::present(Input& input, const FlowContent& content, const Options& options,
                              const SceneSettings& settings, const SceneState* before,
                              Progress& progress) const {
  // Another colour needs no other lines.
  SceneSettings without_color = settings;
  if (before != nullptr) without_color.color_array = before->settings.color_array;
  const bool same_lines = before != nullptr && without_color == before->settings;
  SceneState state = same_lines ? *before : trace(input, content, options, settings, progress);
  if (same_lines) state.settings = settings;
  color(input, content, options, state, progress);
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
  describe_camera(session, view);
  add_option(session, "color",
             settings.color_array.empty() ? std::string(name_of(view.style.color_by)) : settings.color_array);
  add_option(session, "scalar", options.touch.scalar);
}

}  // namespace palpate
