/// Time steps of what is open, one by one or played.
#pragma once

#include <optional>

#include "common/base/clock.h"
#include "common/compose/window_model.h"
#include "common/window/panels/panel.h"

namespace palpate {

[[nodiscard]] bool has_times(const std::optional<SceneState>& scene);
/// To the step whose time comes next, or before; round from the last to the first. Nothing where there is one time.
void step_in_time(Document& document, const std::optional<SceneState>& scene, bool on);

class TimePlay {
 public:
  /// Once a frame: the next step, when it is due and the last one is there. @param busy it is made yet.
  void follow(PanelState& state, const std::optional<SceneState>& scene, bool busy);

 private:
  Stopwatch since_step_;
};

}  // namespace palpate
