#include "common/window/controls/pick_volume.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/hand/mode/haptic_surfaces.h"

namespace palpate {
namespace {

/// How far along the ray it meets a triangle; nothing where it passes (Moeller and Trumbore 1997).
std::optional<double> meets(const ViewRay& ray, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a, across = glm::cross(ray.along, v);
  const double det = glm::dot(u, across);
  if (det == 0.0) return std::nullopt;
  const Vec3 from = ray.from - a;
  const double s = glm::dot(from, across) / det;
  const Vec3 q = glm::cross(from, u);
  const double t = glm::dot(ray.along, q) / det, way = glm::dot(v, q) / det;
  if (s < 0.0 || t < 0.0 || s + t > 1.0 || way < 0.0) return std::nullopt;
  return way;
}

}  // namespace

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

std::optional<Vec3> pick_surface(const ViewRay& ray, const std::vector<SurfaceView>& surfaces,
                                 const std::function<bool(const SurfaceView&)>& counts) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const SurfaceView& surface : surfaces) {
    if (!surface.mesh || !counts(surface)) continue;
    const IsosurfaceMesh& mesh = *surface.mesh;
    for (const auto& [a, b, c] : mesh.triangles)
      if (const auto way = meets(ray, mesh.points[a], mesh.points[b], mesh.points[c]))
        nearest = std::min(nearest, *way);
  }
  if (!std::isfinite(nearest)) return std::nullopt;
  return ray.from + nearest * ray.along;
}

}  // namespace palpate
