// 2D advection: follow the local direction of a flow until the circle is met (Ikits 2006, figure 7.2(a) and (b)).
#include "apps/flow/study/path_task.h"

namespace palpate {

std::shared_ptr<StudyTask> make_advection_2d() {
  return std::make_shared<FlowPathTask>(
      StudyTaskInfo{
          .name = "advection2d",
          .title = "2D advection",
          .pair = "advection3d",
          .instruction =
              "Follow the arrow with the crosshair, in one sweep, as accurately and as quickly as you can. Press the space bar when you have met the circle.",
          .error =
              "distance of the place where the circle was met from where the streamline through the start meets it",
          .flat = true,
          .limit = 10.0,
          .cutoff_time = 10.0,
          .cutoff_error = 30.0},
      PathWish{.flat = true, .goal = PathGoal::kCircle, .length = 0.1});
}

}  // namespace palpate
