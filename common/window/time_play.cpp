#include "common/window/time_play.h"

#include "common/scene/time_steps.h"

namespace palpate {

bool has_times(const std::optional<SceneState>& scene) { return scene && scene->info->times.size() > 1; }

void step_in_time(Document& document, const std::optional<SceneState>& scene, bool on) {
  if (!has_times(scene)) return;
  const std::vector<double>& times = scene->info->times;
  set_time_step(document, times, step_beside(times, time_step_of(document, times), on));
}

void TimePlay::follow(PanelState& state, const std::optional<SceneState>& scene, bool busy) {
  if (!state.playing || !scene || busy) return;
  if (since_step_.seconds() * state.play_rate < 1.0) return;
  since_step_.restart();
  step_in_time(state.document, scene, true);
}

}  // namespace palpate
