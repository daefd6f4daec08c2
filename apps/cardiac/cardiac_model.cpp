#include "apps/cardiac/cardiac_model.h"

#include <utility>

#include "apps/cardiac/heart_scene.h"
#include "common/base/text.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/scalar_choice.h"

namespace palpate {

CardiacModel::CardiacModel(Options options, std::string program)
    : InputModel(std::move(options), std::move(program), FieldKind::kFibre) {}

CardiacContent CardiacModel::read(Input& input, const Options& options, Progress& progress) const {
  return load_layered_heart(input, options.heart, options.common.threads, &progress);
}

void CardiacModel::begin(SceneSettings& settings, const Input& /*input*/, const Options& options) const {
  settings.layer = layer_of(options.heart).value_or(kViewLayer);
  settings.seeds = options.tracing.seeds.empty() ? kViewFibres : options.tracing.seeds;
  settings.max_length = options.tracing.max_length;
  settings.step = options.tracing.step;
  settings.random_seed = options.common.seed;
  settings.color_array = options.heart.angle;
}

SceneState CardiacModel::present(Input& input, const CardiacContent& heart, const Options& options,
                                 const SceneSettings& settings, const SceneState* /*before*/,
                                 Progress& progress) const {
  Options with = options;
  with.heart.layer = exact_number(settings.layer);
  with.heart.angle = settings.color_array.empty() ? options.heart.angle : settings.color_array;
  with.tracing.seeds = settings.seeds;
  with.tracing.max_length = settings.max_length;
  with.tracing.step = settings.step;
  with.common.seed = settings.random_seed;
  LayerScene layer = make_layer_scene(input, heart, with, 1.0, &progress);
  const ScalarField& depth = *heart->heart().layer;

  auto info = std::make_shared<SceneInfo>(describe_open_input(input));
  info->facts.push_back(counted(depth.tet_mesh()->points().size(), "point") + ", " +
                        counted(depth.tet_mesh()->cells().size(), "tetrahedron"));
  info->layers = ValueRange{depth.lowest(), depth.highest()};
  info->color_arrays = {"helix", "transverse", "gap", "depth"};
  if (heart->heart().sheets) info->color_arrays.insert(info->color_arrays.begin() + 2, "sheet");
  // A scalar of the file is read with the heart: the one that was named.
  const HeartOptions& named = options.heart;
  if (heart->heart().value) info->color_arrays.push_back(named.angle);
  if (info->times.size() > 1) {
    for (const ScalarChoice& choice : scalar_choices(input.arrays()))
      info->plotted.push_back(label_of(choice, input.arrays()));
    info->input = input.spec();
  }
  info->bounds = layer.view.bounds;
  info->units = layer.view.units;
  SceneState state = begin_state(input, settings);
  state.info = std::move(info);
  state.lines = layer.view.lines;
  state.felt_scalar = heart->heart().layer;
  state.felt_tensor = heart->heart().fibres;
  state.color_array = layer.view.style.array;
  state.surfaces = std::move(layer.view.surfaces);
  state.style = std::move(layer.view.style);
  state.ends = layer.fibres.ends;
  state.seeds = layer.fibres.lines.size();
  state.outside_seeds = layer.fibres.outside_seeds.size();
  state.error_max = layer.fibres.error_max;
  state.seconds_trace = layer.fibres.seconds;
  state.notes.insert(state.notes.end(), heart->heart().notes.begin(), heart->heart().notes.end());
  return state;
}

void CardiacModel::describe_session(Session& session, const InputSpec& /*spec*/, const Options& options,
                                    const SceneSettings& settings, const SceneView& view) const {
  add_option(session, "layer", exact_number(settings.layer));
  add_option(session, "seeds", settings.seeds);
  add_option(session, "seed", std::to_string(settings.random_seed));
  if (settings.max_length > 0.0) add_option(session, "max-length", exact_number(settings.max_length));
  add_option(session, "angle", settings.color_array);
  add_option(session, "convention", options.heart.convention);
  add_option(session, "axis", options.heart.axis);
  add_option(session, "cut", options.heart.cut);
  describe_camera(session, view);
}

}  // namespace palpate
