#include "common/window/shown_scene.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/compose/appearance.h"
#include "common/window/controls/color_lens_control.h"
#include "common/window/panels/picture_panels.h"

namespace palpate {
namespace {

void show_volume(const SceneState& scene, bool as_made, SceneView& view) {
  const std::optional<VolumeView> before = std::exchange(view.volume, scene.volume);
  view.anatomical = scene.info->anatomical;
  const bool same_field = std::exchange(view.volume_label, scene.volume_label) == scene.volume_label;
  if (!view.volume || !before || as_made) return;
  view.volume->shading = before->shading;
  view.volume->shadows = before->shadows;
  view.volume->illustrated = before->illustrated;
  view.volume->context_fade = before->context_fade;
  view.volume->samples_per_voxel = before->samples_per_voxel;
  view.volume->far_sampling = before->far_sampling;
  view.volume->shown = before->shown;
  view.volume->lenses = before->lenses;
  view.volume->cuts = before->cuts;
  const std::optional<ValueWindow> window = view.volume->planes.window;
  view.volume->planes = before->planes;
  if (!same_field) view.volume->planes.window = window;  // that of other values
  view.volume->panes = before->panes;
  if (scene.tensors) {  // edited in the view alone
    view.volume->transfer = before->transfer;
    view.volume->regions = before->regions;
    view.volume->colored = before->colored;
    return;
  }
  // Lenses go on with their field by its name; one that is gone gives way to that of the context.
  const std::vector<VolumeField>& fields = view.volume->fields;
  for (Lens& lens : view.volume->lenses) {
    if (lens.cut) continue;
    const std::size_t field_before = lens.field;
    if (lens.field > 0) {
      const auto now = std::find_if(fields.begin(), fields.end(), [&](const VolumeField& field) {
        return field.name == before->fields[lens.field - 1].name;
      });
      lens.field = now == fields.end() ? 0 : as_size(now - fields.begin()) + 1;
    }
    const bool gone = field_before > 0 && lens.field == 0;
    if (lens.own_transfer && !gone) continue;
    const Lens appearance = scene.appearance(lens.field);
    lens.transfer = appearance.transfer;
    lens.regions = appearance.regions;
    lens.own_transfer = false;
  }
}

void show_tracts(const SceneState& scene, bool as_made, SceneView& view) {
  const std::optional<TractView> before = std::exchange(view.tracts, scene.tracts);
  if (!view.tracts || !before || as_made) return;
  const auto bundle = view.tracts->bundle;
  view.tracts = before;
  view.tracts->bundle = bundle;
}

// Another time step of an image keeps its slices.
void show_tensors(const SceneState& scene, bool as_made, SceneView& view) {
  const std::optional<TensorView> before = std::exchange(view.tensors, scene.tensors);
  if (!view.tensors) return;
  if (!before || as_made) {
    view.style.color_by = ColorBy::kDirection;
    return;
  }
  const TensorVoxels& voxels = *view.tensors->image;
  TensorView kept = *before;
  kept.image = view.tensors->image;
  kept.underlay = view.tensors->underlay;
  if (kept.underlay && before->underlay) {
    kept.underlay->blend = before->underlay->blend;
    if (kept.underlay->image == before->underlay->image) kept.underlay->window = before->underlay->window;
  }
  if (!voxels.contains(voxels.grid_coordinates(kept.position))) kept.position = view.tensors->position;
  view.tensors = std::move(kept);
}

// A lens stays where it is, whatever it shows.
void show_lens(const SceneState& scene, bool as_made, SceneView& view) {
  const std::optional<ColorLens> before = std::exchange(view.color_lens, scene.color_lens);
  if (!view.color_lens) return;
  if (before && !as_made) {
    view.color_lens->center = before->center;
    view.color_lens->radius = before->radius;
  } else if (!(view.color_lens->radius > 0.0)) {
    place_lens(view, *view.color_lens);
  }
}

// Colours by `array`, or where there is none by a quantity of the lines.
void color_lines(const SceneState& scene, LineStyle& style) {
  const std::shared_ptr<const LineArray>& array = scene.color_array;
  const bool by_array = style.color_by == ColorBy::kArray;
  const bool same = by_array && array && style.array && style.array->name == array->name;
  if (!same && (array || by_array)) {
    style.color_by = array ? ColorBy::kArray : ColorBy::kSpeed;
    if (!array) show_quantity(scene.document.view.color, style);
    style.range.reset();
    style.usual.reset();
    style.logarithmic.reset();
  }
  style.array = array;
}

}  // namespace

void show_scene(const SceneState& scene, ShownAs as, SceneView& view) {
  const bool as_made = as == ShownAs::kNew;
  view.lines = scene.lines;
  view.surfaces = scene.surfaces;
  show_lens(scene, as_made, view);
  color_lines(scene, view.style);
  view.regions = scene.regions;
  view.beside = scene.beside;
  view.bounds = scene.info->bounds;
  view.outline = scene.info->outline;
  view.units = scene.info->units;
  view.title = scene.info->name;
  const std::string& field = scene.document.input.field;
  view.subtitle = (field.empty() ? "" : field + ", ") + size_text(scene);
  const std::vector<double>& times = scene.info->times;
  if (times.size() > 1) view.subtitle += ", time " + short_number(times[time_step_of(scene.document, times)]);
  show_volume(scene, as_made, view);
  show_tensors(scene, as_made, view);
  show_tracts(scene, as_made, view);
  if (as_made) {
    apply_colors(scene.document.view, view.style);
    view.style.usual.reset();
  }
}

void keep_colors(const Document& before, const SceneState& scene, const std::optional<ValueRange>& shown,
                 LineStyle& style) {
  Document then = scene.document;
  const bool other_time = std::exchange(then.input.time, before.input.time) != before.input.time;
  if (!same_scene(then, before)) {
    style.usual.reset();
  } else if (other_time && !style.range && !style.usual && shown && shown->lower < shown->upper) {
    style.usual = shown;
  }
}

ViewEdits edits_of(const SceneView& view) {
  ViewEdits edits{view.style, view.color_lens, view.volume, view.tensors, view.tracts};
  edits.style.array.reset();
  if (edits.color_lens) edits.color_lens->style.array.reset();
  if (edits.volume) {
    edits.volume->image.reset();
    for (VolumeField& field : edits.volume->fields)
      field = {.image = nullptr, .name = field.name, .window = {}};
    edits.volume->slice_images.clear();
  }
  // The underlay stays: its window is of its own values.
  if (edits.tensors) edits.tensors->image.reset();
  if (edits.tracts) edits.tracts->bundle.reset();
  return edits;
}

void put_edits(const ViewEdits& edits, const SceneState& scene, SceneView& view) {
  const std::optional<ValueRange> usual = view.style.usual;  // of what is shown, and no edit
  view.style = edits.style;
  view.style.usual = usual;
  view.style.array = scene.color_array;
  if (view.style.color_by == ColorBy::kArray && !view.style.array) view.style.color_by = ColorBy::kSpeed;
  view.color_lens = edits.color_lens;
  view.volume = edits.volume;
  view.tensors = edits.tensors;
  view.tracts = edits.tracts;
  show_lens(scene, false, view);
  show_volume(scene, false, view);
  show_tensors(scene, false, view);
  show_tracts(scene, false, view);
  if (!edits.color_lens) view.color_lens.reset();
  if (!edits.volume) view.volume.reset();
  if (!edits.tensors) view.tensors.reset();
  if (!edits.tracts) view.tracts.reset();
}

}  // namespace palpate
