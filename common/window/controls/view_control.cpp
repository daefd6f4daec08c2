#include "common/window/controls/view_control.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate {
namespace {

constexpr double kTurnPerHeight = std::numbers::pi;  // [rad] for a drag over the picture's height
constexpr double kZoomPerHeight = 3.0;               // logarithm of the zoom, likewise
constexpr double kZoomPerNotch = 0.14;               // logarithm of the zoom for a notch of the wheel
// Heights of the view in terms of the scene's longest side: beyond them there is nothing to see.
constexpr double kClosest = 1e-5, kFarthest = 50.0;

void zoom_within_limits(Camera& camera, const Box& bounds, double logarithm, double to_right, double to_top) {
  const Vec3 size = bounds.size();
  const double longest = std::max({size.x, size.y, size.z});
  double factor = std::exp(logarithm);
  if (longest > 0.0) {
    const double height = std::clamp(camera.view_height / factor, kClosest * longest, kFarthest * longest);
    factor = camera.view_height / height;
  }
  zoom(camera, factor, to_right, to_top);
}

}  // namespace

bool ViewControl::handle(const InputEvent& event, const PictureArea& area, const Box& bounds,
                         Camera& camera) {
  switch (event.kind) {
    case InputKind::kPress:
      if (!button_ && area.contains(x_, y_)) button_ = event.button;
      return false;
    case InputKind::kRelease:
      if (button_ == event.button) button_.reset();
      return false;
    case InputKind::kMove: {
      const double dx = (event.x - x_) / area.height, dy = (event.y - y_) / area.height;
      x_ = event.x;
      y_ = event.y;
      if (!button_ || (dx == 0.0 && dy == 0.0)) return false;
      switch (*button_) {
        case MouseButton::kLeft:
          turn(camera, kTurnPerHeight * dx, -kTurnPerHeight * dy);
          break;
        case MouseButton::kMiddle:
          pan(camera, dx, -dy);
          break;
        case MouseButton::kRight:
          zoom_within_limits(camera, bounds, -kZoomPerHeight * dy, 0.0, 0.0);
          break;
      }
      return true;
    }
    case InputKind::kWheel:
      if (event.y == 0.0 || !area.contains(x_, y_)) return false;
      zoom_within_limits(camera, bounds, kZoomPerNotch * event.y,
                         (x_ - area.left - 0.5 * area.width) / area.height,
                         (area.top + 0.5 * area.height - y_) / area.height);
      return true;
    default:
      return false;
  }
}

bool ViewControl::look(Command command, const Box& bounds, double aspect, Camera& camera) {
  CameraAngles side{.azimuth = 0.0, .elevation = 0.0}, other{.azimuth = 180.0, .elevation = 0.0};
  switch (command) {
    case Command::kLookAlongX:
      side.azimuth = 90.0;
      other.azimuth = -90.0;
      break;
    case Command::kLookAlongY:
      break;
    case Command::kLookAlongZ:
      side.elevation = 90.0;
      other.elevation = -90.0;
      break;
    default:
      return false;
  }
  const Camera before = camera;
  camera = make_camera(bounds, side, aspect, before.projection);
  constexpr double kThere = 1.0 - 1e-9;  // cosine
  if (glm::dot(before.axes[1], camera.axes[1]) > kThere && glm::dot(before.axes[2], camera.axes[2]) > kThere)
    camera = make_camera(bounds, other, aspect, before.projection);
  return true;
}

}  // namespace palpate
