#include "common/hand/technique/interaction_technique.h"

#include "common/render/stereo/stereo_view.h"

namespace palpate {

WorkbenchPlace place_of(const InteractionGeometry& interaction, const Vec3& middle, double scale) {
  return {middle, interaction.middle, interaction.rotation, interaction.gain / scale};
}

WorkbenchPlace place_of(const Camera& camera, const Screen& screen) {
  const Mat3 turn = camera.axes * glm::transpose(axes(screen));
  return {camera.focal_point, center(screen), glm::normalize(glm::quat_cast(turn)),
          camera.view_height / height(screen)};
}

Camera workbench_camera(const WorkbenchPlace& place, const Screen& screen) {
  return screen_camera(place(screen));
}

bool DesktopTechnique::take(const HandEvent& event, const HandsView& view) noexcept {
  if (const auto* drag = std::get_if<MouseDrag>(&event)) {
    const bool at_proxy = view.held && !intent_.axis;
    const Vec3 from = at_proxy ? at_depth_of(view.camera, intent_.probe, *view.held) : intent_.probe;
    intent_.probe = dragged(view.camera, view.size, from, drag->dx, drag->dy, intent_.axis);
  } else if (const auto* wheel = std::get_if<WheelTurn>(&event)) {
    intent_.probe = pushed(view.camera, intent_.probe, wheel->notches, intent_.axis);
  } else if (const auto* lock = std::get_if<AxisLock>(&event)) {
    intent_.axis = lock->axis;
  } else {
    return false;
  }
  return true;
}

}  // namespace palpate
