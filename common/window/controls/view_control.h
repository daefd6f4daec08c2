/// What the mouse does to the camera: left drag turns about the focal point, middle drag pans, right drag
/// and wheel zoom. Plain arithmetic, no window.
#pragma once

#include <optional>

#include "common/hand/technique/probe_mouse.h"
#include "common/render/camera.h"
#include "common/window/input_event.h"
#include "common/window/keys.h"

namespace palpate {

/// Where the picture lies in the window [pixels].
struct PictureArea {
  double left = 0.0, top = 0.0, width = 1.0, height = 1.0;

  [[nodiscard]] bool contains(double x, double y) const noexcept {
    return x >= left && y >= top && x < left + width && y < top + height;
  }
};

[[nodiscard]] inline PictureSize size_of(const PictureArea& area) noexcept {
  return {static_cast<int>(area.width), static_cast<int>(area.height)};
}

class ViewControl {
 public:
  /// Presses and wheel count over `area` only; a drag goes on outside it until its button is let go.
  /// @return whether the camera changed.
  bool handle(const InputEvent& event, const PictureArea& area, const Box& bounds, Camera& camera);
  /// Looks along an axis of the data at all of `bounds`, upright: along x and y with z up, along z with y up.
  /// First from +x, from -y (x to the right) and from +z; where the camera is there already, from the other
  /// side. @param aspect width / height of the picture. @return whether `command` asks for that.
  static bool look(Command command, const Box& bounds, double aspect, Camera& camera);
  /// Where the mouse has gone while something else was moved by it.
  void place(double x, double y) noexcept {
    x_ = x;
    y_ = y;
  }
  [[nodiscard]] bool dragging() const noexcept { return button_.has_value(); }
  void let_go() noexcept { button_.reset(); }

 private:
  std::optional<MouseButton> button_;
  double x_ = 0.0, y_ = 0.0;
};

}  // namespace palpate
