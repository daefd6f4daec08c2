/// What a verb opens a window with, and what is left of it when it is closed. Command line and window do not
/// know each other: a program hands the one to the other.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "common/compose/window_model.h"
#include "common/hand/probe_session.h"
#include "common/hand/workbench/workbench_display.h"
#include "common/render/scene_view.h"
#include "common/scene/document/document.h"

namespace palpate {

/// Draws a built-in example into a picture of `width` x `height` pixels. Called on another thread; it returns soon
/// once stop is asked for. @throws Error.
using DrawExample = std::function<void(const std::string& example, const std::filesystem::path& to, int width,
                                       int height, const std::stop_token& stop)>;

struct WindowRequest {
  std::string program;       ///< in the title bar
  std::string command_line;  ///< for the text of saved pictures
  bool start_page = false;   ///< in place of what the model was made for
  SceneView view;            ///< what is shown at the start, but for lines, bounds and camera
  std::optional<WorkbenchDisplayOptions> workbench;  ///< the screens of a workbench; none: a desktop
  ProbeSessionOptions touch;                         ///< without modes: the window knows no touch
  DrawExample draw_example;                          ///< for small pictures of examples; may be empty
  std::function<bool()> stop_requested;              ///< asked a few times a second; true closes the window
  std::function<void(const std::string&)> note;      ///< told what of the user's files cannot be written
};

struct WindowOutcome {
  ServoState servo;    ///< as the window was closed
  std::string fault;   ///< where the seconds before a fault were saved; empty: there was none
  std::string replay;  ///< verdict on a replayed recording; empty: it was none, or did not end
};

/// A kind of window.
struct WindowMaker {
  /// Whether one can be opened at all (a display is there).
  bool (*available)() = nullptr;
  /// Takes into `document` what the user of a program prefers, where nothing else was asked for.
  /// @param note told in a sentence what of that cannot be read.
  std::function<void(const std::string& program, Document& document,
                     const std::function<void(const std::string&)>& note)>
      prefer;
  /// Shows it until it is closed. @param options say what is looked at, and how.
  /// @throws Error (work failed) where none can be opened, and whatever WindowModel::start() throws.
  std::function<WindowOutcome(WindowModel& model, const Document& options, WindowRequest request)> open;
};

}  // namespace palpate
