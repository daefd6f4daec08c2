/// A window for each screen of a workbench, beside that of the desktop: without a frame, where the workbench
/// says that its screen is. All show one scene, each from where the head is before it.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "common/hand/workbench/workbench_display.h"
#include "common/render/budget/frame_quality.h"
#include "common/render/scene_view.h"

namespace palpate {

class GlfwWindow;

/// Pictures are drawn in the context of the main window, by one renderer that keeps the scene on the graphics
/// card once more, and copied from there.
class ScreenWindows {
 public:
  /// @param main whose context is current, now and at all calls; it takes their keys, and outlives this.
  /// @param stereo how screens show two eyes that do not say so themselves.
  /// @throws Error (work failed) where a window cannot be opened, such as one for two buffers.
  ScreenWindows(GlfwWindow& main, const WorkbenchDisplayOptions& workbench, const StereoView& stereo,
                bool hidden);
  ~ScreenWindows();
  ScreenWindows(const ScreenWindows&) = delete;
  ScreenWindows& operator=(const ScreenWindows&) = delete;

  /// Draws and shows what has changed. `view`'s camera is that of `workbench`'s screen. Leaves the main window's
  /// context current.
  void draw(const SceneView& view, const WorkbenchDisplay& workbench, const FrameQuality& quality);
  /// Whether one of them was asked to close.
  [[nodiscard]] bool close_asked() const;
  /// What the screens show, as they would be seen in a file.
  [[nodiscard]] std::vector<Image> read() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace palpate
