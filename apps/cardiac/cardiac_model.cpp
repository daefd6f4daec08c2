#include "apps/cardiac/cardiac_model.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "apps/cardiac/default_appearance.h"
#include "apps/cardiac/heart_scene.h"
#include "common/base/text.h"
#include "common/compose/text/lens_text.h"
#include "common/compose/view_keep.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/layer/wall_layer.h"
#include "common/field/layer/wall_surfaces.h"
#include "common/field/scalar_choice.h"

namespace palpate {
namespace {

/// Whether both mean the same lines and triangles of one heart.
bool same_layer(const Document& a, const Document& b) {
  return a.heart.layer == b.heart.layer && a.heart.cut == b.heart.cut && a.tracing == b.tracing &&
         a.common.seed == b.common.seed;
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

CardiacModel::CardiacModel(Document document, std::string program)
    : InputModel(std::move(document), std::move(program), FieldKind::kFibre) {}

CardiacContent CardiacModel::read(Input& input, const Document& document, Progress& progress) const {
  // Most hearts beat in their potentials alone: fibres and layers are made once, however many steps there
  // are.
  const Scene* open = scene();
  const bool other_step = open != nullptr && &open->input == &input && input.times().size() > 1 &&
                          open->shown.document.input.field == input.field_label() &&
                          open->shown.document.input.regions == input.spec().regions &&
                          open->shown.document.input.paint == input.spec().paint;
  CardiacContent content;
  if (other_step) {
    content.print = fingerprint(input, &progress);
    if (content.print == open->content.print) return open->content;
  }
  content.heart = open_heart(input, document.common.threads, &progress);
  return content;
}

void CardiacModel::complete(Document& document, Input& input, Progress& progress) const {
  (void)choose_default_appearance(input, document, &progress);
  if (document.tracing.seeds.empty()) document.tracing.seeds = kViewFibres;
  if (document.heart.layer.empty()) document.heart.layer = exact_number(kViewLayer);
}

SceneState CardiacModel::present(Input& input, const CardiacContent& content, const Document& document,
                                 const SceneState* before, Progress& progress) const {
  if (content.heart.bare) return present_bare(input, content, document, before, progress);
  const auto& heart = content.heart.layered;
  const ScalarField& depth = *heart->heart().layer;
  const int threads = document.common.threads;
  SceneState state = begin_state(input, document);
  state.haptic_scalar = heart->heart().layer;
  state.haptic_tensor = heart->heart().fibres;
  LayerGeometry layer;
  if (before != nullptr && before->haptic_tensor == state.haptic_tensor &&
      same_layer(before->document, document)) {
    layer.lines = before->lines;
    layer.mesh = before->surfaces.front().mesh;
    state.ends = before->ends;
    state.seeds = before->seeds;
    state.outside_seeds = before->outside_seeds;
    state.line_errors = before->line_errors;
    state.seconds_trace = before->seconds_trace;
  } else {
    layer = make_layer_geometry(*heart, document, &progress);
    state.ends = layer.fibres.ends;
    state.seeds = layer.seeds;
    state.outside_seeds = layer.fibres.outside_seeds.size();
    state.line_errors = layer.fibres.errors;
    state.seconds_trace = layer.fibres.seconds;
  }
  const LineArray* const colored = before != nullptr ? before->color_array.get() : nullptr;
  LayerColors colors = color_layer(input, heart, layer, document.heart, threads, colored);
  BesidePicture beside = content.beside->draw(input, content.heart, document, colors.style.array, &progress);
  state.beside = std::move(beside.view);
  state.lines = layer.lines;
  state.surfaces = {surface_of(layer, colors, document.heart.contours)};
  add_wall(input, *heart, document, colors, *content.walls, state.surfaces, &progress);
  if (auto lens = lens_of(document.heart)) {
    HeartOptions inside = document.heart;
    inside.angle = document.heart.lens_angle;
    const LineArray* const seen =
        before != nullptr && before->color_lens ? before->color_lens->style.array.get() : nullptr;
    const LayerColors of_lens = color_layer(input, heart, layer, inside, threads, seen);
    state.surfaces.front().lens_values = of_lens.values;
    state.color_lens = std::move(lens);
    state.color_lens->style = of_lens.style;
  }
  state.color_array = colors.style.array;
  state.document.heart.walls = WallPictures::shown(input, document.heart);

  auto info = std::make_shared<SceneInfo>(describe_open_input(input));
  info->facts.push_back(counted(depth.tet_mesh()->points().size(), "point") + ", " +
                        counted(depth.tet_mesh()->cells().size(), "tetrahedron"));
  info->layers = ValueRange{depth.lowest(), depth.highest()};
  info->color_arrays = colors_of(input, heart->heart().sheets != nullptr);
  if (info->times.size() > 1) {
    info->plotted = scalars_of(input);
    info->input = input.spec();
  }
  info->regions = input.regions(&progress);
  for (RegionCount& region : info->regions)
    region.left_out = std::ranges::count(heart->heart().regions_left_out, region.number) > 0;
  info->bounds = depth.bounds();
  info->units = units_of(input);
  state.info = std::move(info);
  state.notes.insert(state.notes.end(), content.heart.notes.begin(), content.heart.notes.end());
  state.notes.insert(state.notes.end(), beside.notes.begin(), beside.notes.end());
  return state;
}

SceneState CardiacModel::present_bare(Input& input, const CardiacContent& content, const Document& document,
                                      const SceneState* before, Progress& progress) {
  const OpenHeart& heart = content.heart;
  SceneState state = begin_state(input, document);
  const LineArray* const colored = before != nullptr ? before->color_array.get() : nullptr;
  BareScene scene = make_bare_scene(input, *heart.bare, document.heart, document.common.threads, colored);
  state.lines = scene.lines;
  state.surfaces = {std::move(scene.surface)};
  BesidePicture beside = content.beside->draw(input, heart, document, scene.array, &progress);
  state.beside = std::move(beside.view);
  state.color_array = scene.array;
  // A session that has them is refused by render.
  state.document.heart.layer.clear();
  state.document.heart.lens.clear();
  if (!scene.array->name.empty()) state.document.heart.angle = scene.array->name;
  state.notes.insert(state.notes.end(), heart.notes.begin(), heart.notes.end());
  if (!scene.note.empty()) state.notes.push_back(scene.note);
  state.notes.insert(state.notes.end(), beside.notes.begin(), beside.notes.end());
  auto info = std::make_shared<SceneInfo>(describe_open_input(input));
  info->facts.push_back(counted(heart.bare->mesh.triangles.size(), "triangle"));
  info->color_arrays = scalars_of(input);
  if (info->times.size() > 1 && heart.bare->grid) {
    info->plotted = info->color_arrays;
    info->input = input.spec();
  }
  info->regions = input.regions();
  info->bounds = heart.bare->bounds;
  info->units = units_of(input);
  state.info = std::move(info);
  return state;
}

void CardiacModel::keep(const SceneView& view, Document& document) const {
  keep_camera(view, document);
  keep_appearance(view, document);
  // One that the document has no more is on its way out of the view.
  if (view.color_lens && !document.heart.lens.empty())
    document.heart.lens = sphere_text(view.color_lens->center, view.color_lens->radius);
}

}  // namespace palpate
