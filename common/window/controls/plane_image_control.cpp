#include "common/window/controls/plane_image_control.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/window/controls/pick_volume.h"
#include "common/window/keys.h"

namespace palpate {
namespace {

constexpr double kNarrowest = 1e-4;  // of the range of the data

/// Whether `x`, in the plane of a convex polygon with its corners about `normal`, lies in it.
bool holds(const std::vector<Vec3>& polygon, const Vec3& normal, const Vec3& x) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if (glm::dot(glm::cross(b - a, x - a), normal) < 0.0) return false;
  }
  return !polygon.empty();
}

}  // namespace

void drag_window(VolumeView& view, double to_right, double to_top) {
  const double range = view.image->highest - view.image->lowest;
  ValueWindow window = window_of(view);
  window.width = std::max(window.width + range * to_right, kNarrowest * range);
  window.level += range * to_top;
  if (window.width > 0.0) view.planes.window = window;
}

std::optional<Vec3> pick_plane_image(const VolumeView& view, const Camera& camera, const PictureArea& area,
                                     double x, double y) {
  if (!view.planes.shown || view.image == nullptr) return std::nullopt;
  const PictureSize size{static_cast<int>(area.width), static_cast<int>(area.height)};
  const ViewRay ray = view_ray(camera, size, {x - area.left, y - area.top});
  std::optional<Vec3> found;
  double nearest = HUGE_VAL;
  for (std::size_t i = 0; i < view.cuts.size(); ++i) {
    const ConvexShape::HalfSpace& plane = view.cuts[i].kept;
    const double slope = glm::dot(plane.outward, ray.along);
    const double t = (plane.offset - glm::dot(plane.outward, ray.from)) / slope;
    if (!(t > 0.0 && t < nearest)) continue;  // an edge-on plane is not met: t is not finite
    const Vec3 place = ray.from + t * ray.along;
    if (!holds(shown_section(view, i), plane.outward, place)) continue;
    nearest = t;
    found = place;
  }
  return found;
}

bool PlaneImageControl::handle(const InputEvent& event, const PictureArea& area, const Camera& camera,
                               VolumeView& view) {
  switch (event.kind) {
    case InputKind::kMove: {
      const double dx = event.x - x_, dy = event.y - y_;
      x_ = event.x;
      y_ = event.y;
      if (!dragging_) return false;
      drag_window(view, dx / area.width, -dy / area.height);
      return true;
    }
    case InputKind::kPress:
      if (!control_ || event.button != MouseButton::kLeft || !area.contains(x_, y_) ||
          !pick_plane_image(view, camera, area, x_, y_))
        return false;
      dragging_ = true;
      return true;
    case InputKind::kRelease:
      if (!dragging_ || event.button != MouseButton::kLeft) return false;
      dragging_ = false;
      return true;
    case InputKind::kKeyDown:
    case InputKind::kKeyUp:
      if (is_control_key(event.key)) control_ = event.kind == InputKind::kKeyDown;
      return false;
    default:
      return false;
  }
}

}  // namespace palpate
