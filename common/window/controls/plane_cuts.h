/// Cuts of a volume that follow the planes of the hand.
#pragma once

#include "common/hand/probe_session.h"
#include "common/haptics/constraint/plane_widget_settings.h"
#include "common/render/scene_view.h"

namespace palpate {

class PlaneCuts {
 public:
  /// The volume of `view` is cut where the hand has put the planes. They begin where it is cut already.
  /// @return whether a plane has moved.
  bool follow(ProbeSession& touch, SceneView& view);
  /// Another input: no cut stands for a plane.
  void forget() { shown_ = {}; }
  /// An edit was taken back: the first cuts stand for as many planes as the hand had then.
  void restored(const ProbeSession& touch);

 private:
  PlanePoses shown_;  ///< for which the first cuts stand
};

}  // namespace palpate
