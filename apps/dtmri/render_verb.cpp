#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/dtmri/bundles.h"
#include "apps/dtmri/dtmri_verbs.h"
#include "apps/dtmri/slice_images.h"
#include "apps/dtmri/tensor_scene.h"
#include "apps/dtmri/tract_request.h"
#include "common/base/error.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/cli/picture.h"
#include "common/cli/verbs.h"
#include "common/compose/text/slice_panes_text.h"
#include "common/device/probe_path.h"
#include "common/field/tensor/tensor_measure.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/hand/probe_picture.h"
#include "common/hand/touch_options.h"

namespace palpate {
namespace {

void check_input(const Document& options, const Input& input) {
  (void)with_input_role(options, input);  // what cannot be shown is refused before anything is read
}

ViewTracts tracts_of(const Document& options, const VerbContext& context,
                     const std::optional<TensorView>& tensors, const TensorImage& made) {
  if (!options.tract_appearance.file.empty()) {
    const TensorField* const field = tensors ? tensors->image->field.get() : nullptr;
    return read_view_tracts(options.tract_appearance, field, options.common.threads, &context.progress);
  }
  ViewTracts tracts =
      trace_view_tracts(options, *tensors->image,
                        made.image.find(std::string(kConeArray), Association::kPoint), &context.progress);
  if (tracts.bundle->order.empty()) throw work_error("no tract to draw: " + tracts.why_none);
  return tracts;
}

/// The bundles of the options beside what is drawn. @param taken whether one of them has the tracts that are drawn.
void add_bundles(const Document& options, const VerbContext& context, const TensorImage& made, bool taken,
                 DrawnScene& drawn) {
  if (options.tract_appearance.bundles.empty()) return;
  SceneView& view = drawn.view;
  if (!view.tensors && !view.tracts)
    throw usage_error("--bundle: there is no image and no tractogram that bundles could be shown with");
  const std::vector<SliceImage> images = slice_images_in(view.volume, view.tensors);
  const auto voxels = view.tensors ? view.tensors->image : lattice_of_lines(*view.tracts->bundle->lines);
  std::vector<std::string> notes;
  const auto set = make_bundles({.document = options,
                                 .voxels = *voxels,
                                 .cones = made.image.find(std::string(kConeArray), Association::kPoint),
                                 .progress = &context.progress},
                                images, notes);
  const auto together =
      drawn_together(view.tracts && !taken ? view.tracts->bundle : nullptr, *set, images, notes);
  view.tracts = together ? std::optional(make_tract_view(together, options.tract_appearance)) : std::nullopt;
  for (const std::string& note : notes) context.console.note(note);
  for (const BundleView& bundle : set->bundles) {
    drawn.lines += bundle.lines->line_count();
    drawn.points += bundle.lines->points.size();
  }
  drawn.what += ", " + counted(set->bundles.size(), "bundle");
}

/// What a hand on the path has felt of the tensors (Ikits 2006, figure 8.4), and the fixtures that it meets.
void show_touch(const Document& options, const VerbContext& context, DrawnScene& drawn) {
  if (options.hand.path.empty() && options.touch.fixtures.list.empty()) return;
  if (!drawn.view.tensors || !drawn.view.tensors->image->field)
    throw usage_error("--path, --fixture: there are no tensors that a hand could feel");
  const auto& field = drawn.view.tensors->image->field;
  const Workspace workspace = touch_workspace(options.touch, field->bounds().diagonal(), field->frame());
  HapticScene scene{
      nullptr, workspace, touch_settings(options.touch, nullptr, workspace), options.common.threads,
      nullptr, field};
  for (const std::string& note :
       take_fixtures(options.touch, field->bounds(), scene, drawn.view, &context.progress))
    context.console.note(note);
  if (options.hand.path.empty()) return;
  const std::vector<HapticMode> modes = modes_of(FieldKind::kTensor);
  show_hand(std::make_shared<PathHand>(read_probe_path(options.hand.path.string()),
                                       make_chain(find_mode(modes, options.touch.mode), scene), scene,
                                       options.touch, drawn.view.style),
            options, drawn);
}

DrawnScene make_scene(Input& input, const Document& given, const VerbContext& context, double aspect) {
  Document options = with_input_role(given, input);
  // The scene is as large as the tracts of the input, whichever bundle takes them.
  const bool taken = role_of(input) == FileRole::kTracts && options.tract_appearance.file.empty();
  if (taken) options.tract_appearance.file = input.spec().files.front().string();
  DrawnScene drawn;
  TensorSceneParts parts;
  TensorImage made;
  if (role_of(input) == FileRole::kTensors) {
    const bool details = options.panes.layout != PanesOptions{}.layout || options.tracts.max_cone ||
                         !options.tract_appearance.bundles.empty();
    auto field = input.load_tensor(options.common.threads, &context.progress, details ? &made : nullptr);
    if (details) parts.made = &made;
    for (const std::string& line : field->notes().lines) context.console.note(line);
    auto voxels = make_tensor_voxels(std::move(field), input.title(), options.common.threads);
    drawn.field = input.field_label();
    drawn.voxels = voxels->directions.size();
    drawn.what = counted(drawn.voxels, "voxel");
    parts.tensors = make_tensor_view(std::move(voxels), options.tensors);
  }
  if (!options.tract_appearance.file.empty() || !options.tracts.seeds.empty()) {
    const ViewTracts tracts = tracts_of(options, context, parts.tensors, made);
    for (const std::string& note : tracts.notes) context.console.note(note);
    if (!tracts.left_out.empty()) context.console.note(tracts.left_out);
    drawn.lines = tracts.bundle->order.size();
    drawn.points = tracts.bundle->lines->points.size();
    drawn.seconds_trace = tracts.seconds;
    drawn.what += (drawn.what.empty() ? "" : ", ") + counted(drawn.lines, "tract");
    parts.tracts = make_tract_view(tracts.bundle, options.tract_appearance);
  }
  if (!options.tensors.underlay.empty()) {
    const Underlay underlay = load_underlay(options, &context.progress);
    for (const std::string& note : show_underlay(underlay, options, parts.tensors))
      context.console.note(note);
    drawn.what += ", an underlay of " + counted(underlay.image->point_count(), "voxel");
  }
  if (const auto& slices = parts.tensors ? parts.tensors->slices : std::array<bool, 3>{};
      options.tract_appearance.slab && options.panes.layout == PanesOptions{}.layout &&
      std::ranges::count(slices, true) != 1)
    context.console.note(
        "--tract-slab: all tracts are drawn: the scene has no single slice; --slices -,-,0 leaves one");
  drawn.view = make_tensor_scene(input, std::move(parts), options, aspect);
  if (taken) drawn.lines = drawn.points = 0;
  add_bundles(options, context, made, taken, drawn);
  show_touch(options, context, drawn);
  return drawn;
}

ExitCode run_render(const Document& options, const VerbContext& context) {
  const PictureMaker maker{.check =
                               [](const Document& given) {
                                 check_tensor_options(given);
                                 check_view_tracts(given.tracts, given.tract_appearance);
                                 (void)slice_panes_of(given.panes, Box());
                                 check_hand(modes_of(FieldKind::kTensor), given);
                               },
                           .check_input = check_input,
                           .make = make_scene};
  return draw_picture(maker, options, context);
}

}  // namespace

Verb tensor_render_verb(std::vector<UsageExample> examples) {
  return {.name = "render",
          .summary = "draw a picture of the tensors, with or without a display",
          .groups = {Group::kInput, Group::kLines, Group::kView, Group::kPanes, Group::kTouch, Group::kPath,
                     Group::kOut, Group::kPicture, Group::kNotes},
          .examples = std::move(examples),
          .run = run_render};
}

Verb tensor_slice_verb(std::vector<UsageExample> examples) {
  return {.name = "slice",
          .summary = "draw slices of the tensors, with tracts over them, side by side",
          .groups = {Group::kInput, Group::kLines, Group::kView, Group::kPanes, Group::kOut, Group::kPicture,
                     Group::kNotes},
          .examples = std::move(examples),
          .run = [](const Document& given, const VerbContext& context) {
            Document options = given;
            const bool said = std::ranges::find(given.given, "layout") != given.given.end();
            if (!said) options.panes.layout = "4";
            if (options.panes.layout == "1")
              throw usage_error(
                  "slice draws slices: --layout 2 or 4; layout 1, the picture alone, is what render draws");
            return run_render(options, context);
          }};
}

}  // namespace palpate
