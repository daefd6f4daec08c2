#include "common/hand/technique/desktop_technique.h"

namespace palpate {

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
