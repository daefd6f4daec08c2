#include "common/window/controls/plane_cuts.h"

#include "common/window/controls/plane_control.h"

namespace palpate {

bool PlaneCuts::follow(ProbeSession& touch, SceneView& view) {
  if (!touch.planes() || !view.volume) return false;
  if (touch.choice().settings.plane_widget.poses.count == 0) {
    const PlanePoses planes = planes_of(*view.volume, view.bounds.center());
    if (planes.count > 0) {
      touch.put_planes(planes);
      return false;
    }
  }
  const PlanePoses& poses = touch.planes()->poses;
  const bool moved = !(poses == shown_);
  cut_by_planes(*view.volume, poses, shown_.count);
  shown_ = poses;
  return moved;
}

void PlaneCuts::restored(const ProbeSession& touch) {
  if (touch.planes()) shown_.count = touch.choice().settings.plane_widget.poses.count;
}

}  // namespace palpate
