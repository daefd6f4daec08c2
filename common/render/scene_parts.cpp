#include "common/render/scene_parts.h"

#include <algorithm>
#include <cmath>

namespace palpate {

Box reach_of(const SceneView& view) {
  Box box = view.bounds;
  if (view.lines) {
    for (const Line& line : *view.lines) {
      for (const LinePoint& point : line.points) {
        if (is_finite(point.position)) box.include(point.position);
      }
    }
  }
  for (const auto& polyline : view.outline) {
    for (const Vec3& x : polyline) box.include(x);
  }
  if (view.tracts && !view.tracts->bundle->bounds.empty()) {
    box.include(view.tracts->bundle->bounds.lower);
    box.include(view.tracts->bundle->bounds.upper);
  }
  if (view.tensors) {
    const Box voxels = view.tensors->image->bounds();
    box.include(voxels.lower);
    box.include(voxels.upper);
  }
  return box;
}

bool same_box(const Box& a, const Box& b) { return a.lower == b.lower && a.upper == b.upper; }

bool same_still_part(const SceneView& a, const SceneView& b) {
  if (a.probe.has_value() != b.probe.has_value()) return false;
  const bool same_path =
      !a.probe || (a.probe->path.points == b.probe->path.points && a.probe->style == b.probe->style);
  return same_path && a.lines == b.lines && a.style == b.style && a.camera == b.camera &&
         same_box(a.bounds, b.bounds) && a.background == b.background && a.show_outline == b.show_outline &&
         a.outline == b.outline && a.surfaces == b.surfaces && a.color_lens == b.color_lens &&
         a.volume.has_value() == b.volume.has_value() && (!a.volume || same_picture(*a.volume, *b.volume)) &&
         same_tensors(a, b) && a.regions == b.regions && a.tracts == b.tracts && a.slice == b.slice;
}

bool shows_volume(const SceneView& view) { return view.volume && view.volume->shown; }

bool is_transparent(const SceneView& view) { return view.style.opacity < 1.0 || view.style.clearing > 0.0; }

std::optional<LayeredLines> LayeredLines::of(const SceneView& view) {
  if (!shows_volume(view) || !is_transparent(view) || !view.lines || view.lines->empty()) return {};
  return LayeredLines{view.lines, view.style, view.color_lens, view.background};
}

namespace {

bool colors_seeds(const ProbeView& probe, const LineStyle& style) {
  return probe.seeds && probe.seeds->lines && !probe.seeds->lines->empty() &&
         colored_by_value(style_of(*probe.seeds, style));
}

}  // namespace

LineStyle style_of(const LocalSeeds& seeds, const LineStyle& scene) {
  LineStyle style = scene;
  const bool other = !seeds.array || !scene.array || seeds.array->name != scene.array->name;
  // An index of the scene's seeds is none of these.
  if (scene.color_by == ColorBy::kSeed || (scene.color_by == ColorBy::kArray && other))
    style.color_by = ColorBy::kUniform;
  style.array = seeds.array;
  return style;
}

ValueRange range_alone(const ProbeView& probe, const LineStyle& style) {
  if (style.range) return *style.range;
  std::vector<double> values;
  if (probe.followed) values = probe.followed->values;
  std::erase_if(values, [&](double v) { return !std::isfinite(v) || (is_logarithmic(style) && !(v > 0.0)); });
  if (values.empty())
    return colors_seeds(probe, style) ? value_range(*probe.seeds->lines, style_of(*probe.seeds, style))
                                      : ValueRange{};
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return {*least, *most};
}

bool has_colored_lines(const SceneView& view) {
  if (view.lines && !view.lines->empty()) return true;
  if (std::ranges::any_of(view.surfaces,
                          [](const SurfaceView& surface) { return surface.values != nullptr; }))
    return true;
  if (!view.probe) return false;
  return (view.probe->followed && !view.probe->followed->values.empty()) ||
         colors_seeds(*view.probe, view.style);
}

bool has_overlay(const SceneView& view) {
  return !view.title.empty() || !view.subtitle.empty() || !view.caption.empty() || view.show_axes ||
         view.show_color_bar || view.show_scale_bar || view.anatomical || view.slice || view.probe ||
         !view.notes.empty();
}

}  // namespace palpate
