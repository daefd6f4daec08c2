/// What mouse and keys do to slices through tensors: Ctrl and the left button put the crosshair where the
/// mouse is, Ctrl and the wheel move the slice under it, keys move the three of them. Plain arithmetic, no
/// window.
#pragma once

#include <optional>

#include "common/app/window/input_event.h"
#include "common/app/window/keys.h"
#include "common/app/window/view_control.h"
#include "common/render/camera.h"
#include "common/render/tensor/tensor_pick.h"

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
  [[nodiscard]] bool dragging() const noexcept { return dragging_; }
  void let_go() noexcept { dragging_ = false; }

 private:
  double x_ = -1.0, y_ = -1.0;  ///< of the mouse [pixels]
  bool control_ = false;        ///< the key is held
  bool dragging_ = false;
};

}  // namespace palpate
