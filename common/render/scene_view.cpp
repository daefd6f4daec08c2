#include "common/render/scene_view.h"

#include "common/base/index.h"

namespace palpate {

bool same_tensors(const SceneView& a, const SceneView& b) {
  return a.tensors.has_value() == b.tensors.has_value() &&
         (!a.tensors || same_picture(*a.tensors, *b.tensors));
}

bool same_picture(const SceneView& a, const SceneView& b) {
  return a.lines == b.lines && a.style == b.style && a.camera == b.camera && a.stereo == b.stereo &&
         a.bounds.lower == b.bounds.lower && a.bounds.upper == b.bounds.upper && a.units == b.units &&
         a.background == b.background && a.show_outline == b.show_outline && a.show_axes == b.show_axes &&
         a.show_color_bar == b.show_color_bar && a.color_bar_left == b.color_bar_left &&
         a.show_scale_bar == b.show_scale_bar && a.caption == b.caption && a.title == b.title &&
         a.subtitle == b.subtitle && a.outline == b.outline && a.probe.has_value() == b.probe.has_value() &&
         (!a.probe || same_picture(*a.probe, *b.probe)) && a.volume.has_value() == b.volume.has_value() &&
         (!a.volume || same_picture(*a.volume, *b.volume)) && same_tensors(a, b) && a.tracts == b.tracts &&
         a.slice == b.slice && a.regions == b.regions && a.notes == b.notes && a.labels == b.labels &&
         a.volume_label == b.volume_label && a.anatomical == b.anatomical && a.surfaces == b.surfaces &&
         a.color_lens == b.color_lens && a.beside == b.beside;
}

bool has_two_eyes(const SceneView& view) noexcept {
  return view.stereo.mode != StereoMode::kNone && view.camera.projection == Projection::kPerspective;
}

std::string length_unit(const SceneView& view) {
  return view.units.length.empty() && view.anatomical ? "mm" : view.units.length;
}

std::array<int, 4> Image::pixel(int x, int y) const noexcept {
  const std::uint8_t* p = rgba.data() + 4 * (as_size(y) * as_size(width) + as_size(x));
  return {p[0], p[1], p[2], p[3]};
}

}  // namespace palpate
