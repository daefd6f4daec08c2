#include "common/window/injected_events.h"

#include <algorithm>
#include <array>
#include <optional>

#include "common/window/event_text.h"
#include "common/window/keys.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {
namespace {

/// Where the mouse is to be in the window [pixels]; none where no such control was drawn.
std::optional<Vec2> place_of_control(const ScriptedEvent& scripted) {
  int before = 0;
  for (const DrawnControl& control : drawn_controls()) {
    if (control.label != scripted.control || before++ < scripted.which) continue;
    return Vec2{control.left + scripted.across * control.width, control.top + scripted.down * control.height};
  }
  return std::nullopt;
}

}  // namespace

bool awaits_control(const std::vector<ScriptedEvent>& script, int frame) {
  return std::ranges::any_of(script, [&](const ScriptedEvent& scripted) {
    return scripted.frame == frame && !scripted.control.empty() &&
           (!place_of_control(scripted) || scrolls_to_control(scripted.control, scripted.which));
  });
}

std::vector<std::string> inject_script(const std::vector<ScriptedEvent>& script, int frame,
                                       std::vector<InputEvent>& events) {
  std::vector<std::string> missing;
  for (const ScriptedEvent& scripted : script) {
    if (scripted.frame != frame) continue;
    if (!scripted.control.empty()) {
      const auto place = place_of_control(scripted);
      if (!place) {
        missing.push_back(scripted.control);
        continue;
      }
      events.push_back({.kind = InputKind::kMove, .x = place->x, .y = place->y});
      if (scripted.event.kind == InputKind::kMove) continue;
    }
    events.push_back(scripted.event);
  }
  return missing;
}

void inject_replayed(ProbeSession& touch, std::vector<InputEvent>& events, PanelState& state) {
  for (const std::string& text : touch.servo().due_events()) {
    const auto event = event_from_text(text);
    if (!event) continue;
    const auto command = command_of(*event);
    constexpr std::array kOfTheWindow{Command::kExportPicture, Command::kQuit,      Command::kFullScreen,
                                      Command::kSavePicture,   Command::kSaveLines, Command::kOpen,
                                      Command::kSaveSession,   Command::kClose,     Command::kSaveSessionAs,
                                      Command::kStartPage};
    if (command && std::ranges::find(kOfTheWindow, *command) != kOfTheWindow.end()) continue;
    events.push_back(*event);
  }
  if (const std::string verdict = touch.servo().replay_verdict(); verdict != state.replay_verdict) {
    state.replay_verdict = verdict;
    state.say("replay " + verdict);
  }
}

}  // namespace palpate
