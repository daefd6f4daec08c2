#include "common/window/controls/tract_pick_control.h"

namespace palpate {

PickBeam beam_under_mouse(const Camera& camera, const PictureSize& size, const PicturePoint& mouse,
                          double pixels) {
  const Vec3 place = under_mouse(camera, size, mouse, camera.focal_point);
  const double radius = pixels * camera.view_height / size.height;
  if (camera.projection == Projection::kOrthographic) {
    constexpr double kFar = 1e3;  // views before the focal plane: before any scene
    return {.origin = place + kFar * camera.view_height * camera.axes[2],
            .direction = -camera.axes[2],
            .radius = radius,
            .spread = 0.0};
  }
  const Vec3 from = eye(camera);
  return {.origin = from,
          .direction = glm::normalize(place - from),
          .radius = 0.0,
          .spread = radius / glm::length(place - from)};
}

bool TractPickControl::handle(const InputEvent& event, const PictureArea& area, const Camera& camera,
                              const std::optional<Vec3>& place) {
  constexpr double kPixels = 8.0;
  switch (event.kind) {
    case InputKind::kPress:
      if (!on || event.button != MouseButton::kLeft || !area.contains(event.x, event.y)) return false;
      held_ = true;
      asked_ = TractPick{
          .beam = beam_under_mouse(camera, size_of(area), {event.x - area.left, event.y - area.top}, kPixels),
          .place = place};
      return true;
    case InputKind::kMove:
      return held_;
    case InputKind::kRelease:
      if (!held_ || event.button != MouseButton::kLeft) return false;
      held_ = false;
      return true;
    default:
      return false;
  }
}

}  // namespace palpate
