/// Events that nobody makes at the mouse: those of a script, and those of a recording that is replayed.
#pragma once

#include <string>
#include <vector>

#include "common/hand/probe_session.h"
#include "common/window/input_event.h"
#include "common/window/panels/panel.h"
#include "common/window/window.h"

namespace palpate {

/// Whether a control that `script` names for that frame is not drawn, or is out of sight: it is scrolled to.
[[nodiscard]] bool awaits_control(const std::vector<ScriptedEvent>& script, int frame);

/// Adds what `script` has for that frame to `events`. A control whose label was not drawn gets none.
/// @return the labels of those controls.
[[nodiscard]] std::vector<std::string> inject_script(const std::vector<ScriptedEvent>& script, int frame,
                                                     std::vector<InputEvent>& events);

/// Adds what the recording that `touch` replays says that mouse and keys did, by now. It saves nothing again and does not
/// close the window. The verdict on the replay goes to `state`.
void inject_replayed(ProbeSession& touch, std::vector<InputEvent>& events, PanelState& state);

}  // namespace palpate
