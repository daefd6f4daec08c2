#include "common/window/controls/pick_volume.h"

#include <algorithm>
#include <cmath>

#include "common/hand/mode/haptic_surfaces.h"

namespace palpate {

ViewRay view_ray(const Camera& camera, const PictureSize& size, const PicturePoint& mouse) {
  const Vec3 middle = under_mouse(camera, size, mouse, camera.focal_point);
  if (camera.projection == Projection::kOrthographic) {
    constexpr double kBehind = 1e3;  // heights of the view
    return {middle + kBehind * camera.view_height * camera.axes[2], -camera.axes[2]};
  }
  const Vec3 viewer = eye(camera);
  return {viewer, glm::normalize(middle - viewer)};
}

std::optional<Vec3> pick_volume(const VolumeView& view, const Box& bounds,
                                const std::shared_ptr<const ScalarField>& field, double isovalue,
                                const Camera& camera, const PictureSize& size, const PicturePoint& mouse) {
  const ViewRay ray = view_ray(camera, size, mouse);
  const Vec3 half = 0.5 * bounds.size();
  const LineInterval inside = clip_line(
      make_box(bounds.center(), Mat3(Vec3(half.x, 0.0, 0.0), Vec3(0.0, half.y, 0.0), Vec3(0.0, 0.0, half.z))),
      ray.from, ray.along);
  double first = std::max(inside.first, 0.0);
  if (!(first < inside.last)) return std::nullopt;
  bool on_cut = false;
  double last = inside.last;
  for (const CuttingPlane& cut : view.cuts) {
    if (!cut.on) continue;
    const LineInterval kept = clip_line({.quadric = {}, .half_spaces = {cut.kept}}, ray.from, ray.along);
    on_cut = on_cut || kept.first > first;
    first = std::max(first, kept.first);
    last = std::min(last, kept.last);
  }
  // In heights of the picture from its middle.
  const PicturePoint at{(mouse.x - 0.5 * size.width) / size.height,
                        (0.5 * size.height - mouse.y) / size.height};
  // Lenses overlap: after each one that the place lies in, all are looked at again.
  for (std::size_t n = 0; n <= view.lenses.size(); ++n) {
    const double before = first;
    for (const Lens& lens : view.lenses) {
      if (!lens.cut || (lens.screen && !lens.screen->holds(at.x, at.y))) continue;
      const LineInterval gone = clip_line(lens.shape, ray.from, ray.along);
      if (gone.first <= first && first < gone.last) first = gone.last;
    }
    if (first == before) break;
    on_cut = true;
  }
  if (!(first < last)) return std::nullopt;
  const Vec3 entry = ray.from + first * ray.along;
  if (on_cut || !field) return on_cut ? std::optional(entry) : std::nullopt;
  return first_surface_between({field, Isovalues{{isovalue}, 1}}, entry, ray.from + last * ray.along);
}

}  // namespace palpate
