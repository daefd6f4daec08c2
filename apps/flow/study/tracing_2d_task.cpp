// 2D tracing: follow a drawn streamline to its end (Ikits 2006, figure 7.2(c) and (d)).
#include "apps/flow/study/path_task.h"

namespace palpate {

std::shared_ptr<StudyTask> make_tracing_2d() {
  return std::make_shared<FlowPathTask>(
      StudyTaskInfo{
          .name = "tracing2d",
          .title = "2D tracing",
          .pair = "tracing3d",
          .instruction =
              "Trace the red line with the crosshair and stay on it all the time. Press the space bar at its end.",
          .error = "mean distance of the cursor from the red line",
          .flat = true,
          .limit = 10.0,
          .cutoff_time = 12.0,
          .cutoff_error = 30.0},
      PathWish{.flat = true, .goal = PathGoal::kEnd, .length = 0.1});
}

}  // namespace palpate
