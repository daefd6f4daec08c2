#include <algorithm>
#include <string>
#include <utility>

#include "apps/cardiac/beside_heart.h"
#include "apps/cardiac/cardiac_verbs.h"
#include "apps/cardiac/cut_away.h"
#include "apps/cardiac/default_appearance.h"
#include "apps/cardiac/heart_scene.h"
#include "common/base/error.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/cli/picture.h"
#include "common/cli/verbs.h"
#include "common/compose/appearance.h"
#include "common/compose/line_view.h"
#include "common/device/probe_path.h"
#include "common/field/grid/tet_mesh.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/hand/probe_picture.h"
#include "common/hand/touch_options.h"
#include "common/scene/seeds.h"

namespace palpate {
namespace {

void check(const Document& options) {
  (void)layer_of(options.heart);
  (void)parse_cut(options.heart.cut);
  (void)lens_of(options.heart);
  if (!options.tracing.seeds.empty()) (void)parse_seeds(options.tracing.seeds);
  check_hand(modes_of(FieldKind::kFibre), options);
}

void show_beside(const Input& input, const OpenHeart& open, const Document& options,
                 const VerbContext& context, std::shared_ptr<const LineArray>& array, SceneView& view) {
  BesidePicture beside = BesideHeart().draw(input, open, options, array, &context.progress);
  for (const std::string& note : beside.notes) context.console.note(note);
  view.beside = std::move(beside.view);
}

/// @throws Error (usage) where what is asked for takes layers.
DrawnScene make_bare(Input& input, const OpenHeart& open, const Document& options, const VerbContext& context,
                     double aspect) {
  const BareHeart& heart = *open.bare;
  const char* const layers = !options.heart.layer.empty()  ? "--layer"
                             : !options.heart.lens.empty() ? "--lens"
                             : !options.hand.path.empty()  ? "--path"
                                                           : nullptr;
  if (layers != nullptr) throw usage_error(std::string(layers) + ": " + heart.notes.front());
  for (const std::string& note : open.notes) context.console.note(note);
  DrawnScene drawn;
  BareScene scene = make_bare_scene(input, heart, options.heart, options.common.threads, nullptr);
  show_beside(input, open, options, context, scene.array, drawn.view);
  if (!scene.note.empty()) context.console.note(scene.note);
  drawn.field = scene.array->name;
  drawn.lines = scene.lines->size();
  drawn.points = 2 * drawn.lines;
  const bool tree = heart.mesh.triangles.empty();
  if (!tree) drawn.what = counted(heart.mesh.triangles.size(), "triangle");
  if (!heart.strokes.empty()) drawn.what += ", " + counted(heart.strokes.size(), "stroke");
  if (!heart.branches.empty()) drawn.what += (tree ? "" : ", ") + counted(heart.branches.size(), "line");
  SceneView& view = drawn.view;
  view.style.color_by = ColorBy::kArray;
  view.style.array = scene.array;
  apply_appearance(options, view);
  view.show_color_bar = view.show_color_bar && !scene.array->name.empty();
  view.surfaces = {std::move(scene.surface)};
  view.lines = std::move(scene.lines);
  view.bounds = heart.bounds;
  view.title = input.title();
  view.subtitle = tree ? "lines" : "surface";
  if (!scene.array->name.empty()) view.subtitle += ", " + scene.array->name;
  if (input.times().size() > 1) view.subtitle += ", time " + short_number(input.times()[input.time().step]);
  if (options.heart.contours > 0.0) view.subtitle += ", lines every " + short_number(options.heart.contours);
  view.units = units_of(input);
  view.camera = camera_of(options.view, view.bounds, aspect, view.camera.projection);
  return drawn;
}

DrawnScene make_scene(Input& input, const Document& given, const VerbContext& context, double aspect) {
  Document options = given;
  const std::string chosen = choose_default_appearance(input, options, &context.progress);
  if (!chosen.empty()) context.console.note(chosen);
  const OpenHeart open = open_heart(input, options.common.threads, &context.progress);
  if (open.bare) return make_bare(input, open, options, context, aspect);
  const auto& heart = open.layered;
  LayerScene layer = make_layer_scene(input, heart, options, aspect, &context.progress);
  DrawnScene drawn;
  drawn.field = input.field_label();
  drawn.seconds_trace = layer.layer.fibres.seconds;
  drawn.lines = static_cast<std::size_t>(
      std::ranges::count_if(*layer.layer.lines, [](const Line& line) { return line.points.size() > 1; }));
  drawn.points = layer.layer.fibres.points;
  drawn.what = counted(drawn.lines, "fibre");
  drawn.view = std::move(layer.view);
  show_beside(input, open, options, context, drawn.view.style.array, drawn.view);
  if (!options.hand.path.empty() || !options.touch.fixtures.list.empty()) {
    const ScalarField& depth = *heart->heart().layer;
    const Workspace workspace = touch_workspace(options.touch, depth.diagonal(), depth.frame());
    HapticScene scene{nullptr,
                      workspace,
                      touch_settings(options.touch, nullptr, workspace),
                      options.common.threads,
                      heart->heart().layer,
                      heart->heart().fibres};
    for (const std::string& note :
         take_fixtures(options.touch, depth.bounds(), scene, drawn.view, &context.progress))
      context.console.note(note);
    if (options.hand.path.empty()) return drawn;
    const std::vector<HapticMode> modes = modes_of(FieldKind::kFibre);
    show_hand(std::make_shared<PathHand>(read_probe_path(options.hand.path.string()),
                                         make_chain(find_mode(modes, options.touch.mode), scene), scene,
                                         options.touch, drawn.view.style),
              options, drawn);
  }
  return drawn;
}

}  // namespace

Verb render_layers_verb(std::vector<UsageExample> examples) {
  return {.name = "render",
          .summary = "draw a layer of the wall with its fibres, with or without a display",
          .groups = {Group::kInput, Group::kLines, Group::kLayer, Group::kAngle, Group::kView, Group::kTouch,
                     Group::kPath, Group::kOut, Group::kPicture, Group::kNotes},
          .examples = std::move(examples),
          .run = [](const Document& options, const VerbContext& context) {
            const PictureMaker maker{
                .check = check,
                .check_input = [](const Document&, const Input& input) { (void)input.field_label(); },
                .make = make_scene};
            return draw_picture(maker, options, context);
          }};
}

}  // namespace palpate
