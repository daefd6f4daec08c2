// 3D advection: follow the local direction of a flow to a ground plane (Ikits 2006, figure 7.3(a) and (b)).
#include "apps/flow/study/path_task.h"

namespace palpate {

std::shared_ptr<StudyTask> make_advection_3d() {
  return std::make_shared<FlowPathTask>(
      StudyTaskInfo{
          .name = "advection3d",
          .title = "3D advection",
          .pair = "advection2d",
          .instruction =
              "Follow the arrow with the crosshair, in one sweep, down to the checkered plane, which you can feel. Press the space bar when you have met it.",
          .error =
              "distance of the place where the plane was met from where the streamline through the start meets it",
          .flat = false,
          .limit = 10.0,
          .cutoff_time = 15.0,
          .cutoff_error = 100.0},
      PathWish{.flat = false, .goal = PathGoal::kPlane, .length = 0.1});
}

}  // namespace palpate
