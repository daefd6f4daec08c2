// 3D tracing: follow a drawn streamline in space to its end (Ikits 2006, figure 7.3(c) and (d)).
#include "apps/flow/study/path_task.h"

namespace palpate {

std::shared_ptr<StudyTask> make_tracing_3d() {
  return std::make_shared<FlowPathTask>(
      StudyTaskInfo{
          .name = "tracing3d",
          .title = "3D tracing",
          .pair = "tracing2d",
          .instruction =
              "Trace the red line with the crosshair and stay on it all the time, in depth too. Press the space bar at its end.",
          .error = "mean distance of the cursor from the red line",
          .flat = false,
          .limit = 10.0,
          .cutoff_time = 17.0,
          .cutoff_error = 100.0},
      PathWish{.flat = false, .goal = PathGoal::kEnd, .length = 0.1});
}

}  // namespace palpate
