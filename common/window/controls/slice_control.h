/// What mouse and keys do to slices through tensors: a click, or a drag of the left button with Ctrl, puts
/// the crosshair where the mouse is, the wheel moves the slice under it, keys move the three of them. Beside
/// slices, and with Ctrl, the wheel is left to the camera: both as in MRview and in 3D Slicer's slice views.
/// Plain arithmetic, no window.
#pragma once

#include <optional>

#include "common/render/camera.h"
#include "common/render/scene_view.h"
#include "common/render/tensor/tensor_view.h"
#include "common/window/controls/view_control.h"
#include "common/window/input_event.h"
#include "common/window/keys.h"

namespace palpate {

class SliceControl {
 public:
  /// Presses and wheel count over `area` only. @return whether the event was for the slices.
  bool handle(const InputEvent& event, const PictureArea& area, const Camera& camera, TensorView& view);
  /// @return whether the command was one about slices.
  static bool run(Command command, TensorView& view);
  /// What lies under the mouse, where it is over the picture and a slice.
  [[nodiscard]] std::optional<TensorPick> under_mouse(const PictureArea& area, const Camera& camera,
                                                      const TensorView& view) const;
  /// Where the mouse has gone while something else was moved by it.
  void place(double x, double y) noexcept {
    x_ = x;
    y_ = y;
  }
  [[nodiscard]] bool dragging() const noexcept { return dragging_; }
  void let_go() noexcept { dragging_ = clicking_ = false; }

 private:
  double x_ = -1.0, y_ = -1.0;  ///< of the mouse [pixels]
  bool control_ = false;        ///< the key is held
  bool dragging_ = false;
  bool clicking_ = false;                     ///< the left button is down and has not moved away
  double pressed_x_ = 0.0, pressed_y_ = 0.0;  ///< where it went down [pixels]
};

/// Keeps the crosshair of slices beside the picture and the place of a TensorView's slices the same: whichever has moved
/// leads the other.
class CrosshairLink {
 public:
  void follow(SceneView& view);

 private:
  Vec3 last_{0.0};  ///< of the crosshair
};

}  // namespace palpate
