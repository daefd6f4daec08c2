/// The verb that opens the window: what all explorers share of it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/cli/explorer.h"
#include "common/compose/window_model.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/hand/window_request.h"

namespace palpate {

/// What the window of an explorer is made of.
struct WindowVerb {
  std::string summary;  ///< "look at lines in a window (…)"
  Groups groups;
  WindowMaker window;
  std::vector<HapticMode> modes;  ///< the default one first; none: the window knows no touch
  Verb render;                    ///< draws in place of the window where there is no display
  std::string next;               ///< another command to try then, without the program's name
  /// Refuses options before anything is opened. @throws Error (usage).
  std::function<void(const Document&)> check;
  /// @param program its name, for sessions.
  std::function<std::unique_ptr<WindowModel>(const Document&, const std::string& program)> model;
};

/// The verb `open`. Without a file it shows the start page, or where settings of a scene are
/// given, the first example; without a display it draws that one.
[[nodiscard]] Verb make_open_verb(WindowVerb window, std::vector<UsageExample> examples);

}  // namespace palpate
