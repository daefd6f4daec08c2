#include "apps/cardiac/cardiac_model.h"

#include <algorithm>
#include <functional>
#include <span>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "apps/cardiac/cut_away.h"
#include "apps/cardiac/usual_look.h"
#include "common/base/text.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/layer/wall_layer.h"
#include "common/field/layer/wall_surfaces.h"
#include "common/field/scalar_choice.h"
#include "common/math/vec_text.h"

namespace palpate {
namespace {

/// Of all that the heart is made of, at the input's time step; never 0.
std::uint64_t fingerprint(Input& input, Progress& progress) {
  std::uint64_t print = 1;
  const auto add = [&](const auto& numbers) {
    const auto bytes = std::as_bytes(std::span(numbers));
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15U;  // turns the bits over, so that order counts
    print = (print ^ std::hash<std::string_view>()(text)) * kOdd;
  };
  for (const DataSet& block : input.read(input.heart_choice().arrays(), &progress)) {
    for (const DataArray& array : block.arrays) add(array.bytes);
    if (const auto* cells = std::get_if<UnstructuredTopology>(&block.topology)) {
      add(cells->positions.bytes);
      add(cells->types);
      add(cells->connectivity);
    } else if (const auto* points = std::get_if<StructuredTopology>(&block.topology)) {
      add(points->positions.bytes);
    }
  }
  return std::max<std::uint64_t>(print, 1);
}

/// Whether both mean the same lines and triangles of one heart.
bool same_layer(const SceneSettings& a, const SceneSettings& b) {
  return a.layer == b.layer && a.seeds == b.seeds && a.max_length == b.max_length && a.step == b.step &&
         a.random_seed == b.random_seed && a.cut == b.cut;
}

/// As --cut takes it; empty: none.
std::string cut_text(const std::optional<ConvexShape::HalfSpace>& cut) {
  return cut ? exact_text(cut->outward) + "," + exact_number(cut->offset) : std::string();
}

/// By their labels, the likeliest one first.
std::vector<std::string> scalars_of(const Input& input) {
  std::vector<std::string> labels;
  for (const ScalarChoice& choice : scalar_choices(input.arrays()))
    labels.push_back(label_of(choice, input.arrays()));
  return labels;
}

/// In the order in which they are looked for: angles, the file's own scalars, how deep and how well defined
/// fibres are, and last what lengths and components of vectors there are.
std::vector<std::string> colors_of(const Input& input, bool sheets) {
  std::vector<std::string> colors{"helix", "transverse"}, others;
  if (sheets) colors.emplace_back("sheet");
  for (const ScalarChoice& choice : scalar_choices(input.arrays())) {
    if (choice.array == kLayerArray) continue;  // is the depth
    const std::string label = label_of(choice, input.arrays());
    const bool of_muscle = label == choice.array && choice.array != kSurfaceArray;
    (of_muscle ? colors : others).push_back(label);
  }
  colors.insert(colors.end(), {"depth", "gap"});
  colors.insert(colors.end(), others.begin(), others.end());
  return colors;
}

}  // namespace

CardiacModel::CardiacModel(Options options, std::string program)
    : InputModel(std::move(options), std::move(program), FieldKind::kFibre) {}

CardiacContent CardiacModel::read(Input& input, const Options& options, Progress& progress) const {
  // Most hearts beat in their potentials alone: fibres and layers are made once, however many steps there
  // are.
  const Scene* open = scene();
  const bool other_step = open != nullptr && &open->input == &input && input.times().size() > 1 &&
                          open->shown.settings.field == input.field_label();
  CardiacContent content;
  if (other_step) {
    content.print = fingerprint(input, progress);
    if (content.print == open->content.print) return open->content;
  }
  content.heart = load_layered_heart(input, HeartOptions(), options.common.threads, &progress);
  return content;
}

void CardiacModel::complete(Options& options, Input& input, Progress& progress) const {
  (void)choose_usual_look(input, options, &progress);
}

void CardiacModel::begin(SceneSettings& settings, const Input& /*input*/, const Options& options) const {
  settings.layer = layer_of(options.heart).value_or(kViewLayer);
  settings.seeds = options.tracing.seeds.empty() ? kViewFibres : options.tracing.seeds;
  settings.max_length = options.tracing.max_length;
  settings.step = options.tracing.step;
  settings.random_seed = options.common.seed;
  settings.color_array = options.heart.angle;
  settings.contours = options.heart.contours;
  if (const auto plane = parse_cut(options.heart.cut)) settings.cut = {plane->normal, plane->distance};
  if (!options.heart.lens.empty()) settings.lens_array = options.heart.lens_angle;
}

SceneState CardiacModel::present(Input& input, const CardiacContent& content, const Options& options,
                                 const SceneSettings& settings, const SceneState* before,
                                 Progress& progress) const {
  const auto& heart = content.heart;
  const ScalarField& depth = *heart->heart().layer;
  const int threads = options.common.threads;
  Options with = options;
  with.heart.layer = exact_number(settings.layer);
  with.heart.cut = cut_text(settings.cut);
  with.heart.angle = settings.color_array.empty() ? options.heart.angle : settings.color_array;
  with.tracing.seeds = settings.seeds;
  with.tracing.max_length = settings.max_length;
  with.tracing.step = settings.step;
  with.common.seed = settings.random_seed;

  SceneState state = begin_state(input, settings);
  state.felt_scalar = heart->heart().layer;
  state.felt_tensor = heart->heart().fibres;
  LayerGeometry layer;
  if (before != nullptr && before->felt_tensor == state.felt_tensor &&
      same_layer(before->settings, settings)) {
    layer.lines = before->lines;
    layer.mesh = before->surfaces.front().mesh;
    state.ends = before->ends;
    state.seeds = before->seeds;
    state.outside_seeds = before->outside_seeds;
    state.error_max = before->error_max;
    state.seconds_trace = before->seconds_trace;
  } else {
    layer = make_layer_geometry(*heart, with, &progress);
    state.ends = layer.fibres.ends;
    state.seeds = layer.lines->size();
    state.outside_seeds = layer.fibres.outside_seeds.size();
    state.error_max = layer.fibres.error_max;
    state.seconds_trace = layer.fibres.seconds;
  }
  const LineArray* const colored = before != nullptr ? before->color_array.get() : nullptr;
  LayerColors colors = color_layer(input, heart, layer, with.heart, threads, colored);
  state.lines = layer.lines;
  state.surfaces = {surface_of(layer, colors, settings.contours)};
  if (!settings.lens_array.empty()) {
    with.heart.angle = settings.lens_array;
    const LineArray* const seen =
        before != nullptr && before->color_lens ? before->color_lens->style.array.get() : nullptr;
    const LayerColors inside = color_layer(input, heart, layer, with.heart, threads, seen);
    state.surfaces.front().lens_values = inside.values;
    state.color_lens = lens_of(options.heart).value_or(ColorLens());
    state.color_lens->style = inside.style;
  }
  state.color_array = colors.style.array;
  state.style = std::move(colors.style);
  state.style->range = range_of(options.heart);

  auto info = std::make_shared<SceneInfo>(describe_open_input(input));
  info->facts.push_back(counted(depth.tet_mesh()->points().size(), "point") + ", " +
                        counted(depth.tet_mesh()->cells().size(), "tetrahedron"));
  info->layers = ValueRange{depth.lowest(), depth.highest()};
  info->color_arrays = colors_of(input, heart->heart().sheets != nullptr);
  if (info->times.size() > 1) {
    info->plotted = scalars_of(input);
    info->input = input.spec();
  }
  info->bounds = depth.bounds();
  info->units = units_of(input);
  state.info = std::move(info);
  state.notes.insert(state.notes.end(), heart->heart().notes.begin(), heart->heart().notes.end());
  return state;
}

void CardiacModel::describe_session(Session& session, const InputSpec& /*spec*/, const Options& options,
                                    const SceneSettings& settings, const SceneView& view) const {
  const InputOptions &input = options.input, usual;
  if (input.refine > 0) add_option(session, "refine", std::to_string(input.refine));
  if (input.cell_directions != usual.cell_directions)
    add_option(session, "cell-directions", input.cell_directions);
  add_option(session, "mesher", input.mesher);
  if (input.largest_volume > 0.0) add_option(session, "largest-volume", exact_number(input.largest_volume));
  if (input.cache != usual.cache) add_option(session, "cache", input.cache);
  add_option(session, "surface-markers", input.surface_markers);
  add_option(session, "layer", exact_number(settings.layer));
  add_option(session, "seeds", settings.seeds);
  add_option(session, "seed", std::to_string(settings.random_seed));
  if (settings.max_length > 0.0) add_option(session, "max-length", exact_number(settings.max_length));
  if (settings.step > 0.0) add_option(session, "step", exact_number(settings.step));
  if (options.heart.least_gap != HeartOptions().least_gap)
    add_option(session, "least-gap", exact_number(options.heart.least_gap));
  add_option(session, "angle", settings.color_array);
  add_option(session, "convention", options.heart.convention);
  add_option(session, "axis", options.heart.axis);
  add_option(session, "cut", cut_text(settings.cut));
  if (settings.contours > 0.0) add_option(session, "contour-spacing", exact_number(settings.contours));
  if (view.style.range)
    add_option(session, "range",
               exact_number(view.style.range->lower) + "," + exact_number(view.style.range->upper));
  if (view.color_lens) {
    const Vec3& x = view.color_lens->center;
    add_option(session, "lens", "sphere:" + exact_text(x) + "," + exact_number(view.color_lens->radius));
    add_option(session, "lens-angle", settings.lens_array);
  }
  describe_projection(session, view);
  describe_camera(session, view);
}

}  // namespace palpate
