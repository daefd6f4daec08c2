/// What the mouse does to the picture on planes: a drag of the left button with Ctrl that begins on one sets
/// the grey values, to the right a wider window, upward a higher level, the whole picture being the range of
/// the data: as window and level are set in viewers of medical images. Plain arithmetic, no window.
#pragma once

#include <optional>

#include "common/render/camera.h"
#include "common/render/volume/volume_view.h"
#include "common/window/controls/view_control.h"
#include "common/window/input_event.h"

namespace palpate {

class PlaneImageControl {
 public:
  /// Presses count over `area` only. @return whether the event was for the planes.
  bool handle(const InputEvent& event, const PictureArea& area, const Camera& camera, VolumeView& view);
  [[nodiscard]] bool dragging() const noexcept { return dragging_; }
  void let_go() noexcept { dragging_ = false; }

 private:
  double x_ = -1.0, y_ = -1.0;  ///< of the mouse [pixels]
  bool control_ = false;        ///< the key is held
  bool dragging_ = false;
};

/// Sets the grey values by a drag, in parts of the picture: to the right a wider window, upward a higher level.
void drag_window(VolumeView& view, double to_right, double to_top);

/// Where the ray of a place in the picture first meets what is drawn on a plane; nothing where it meets none.
[[nodiscard]] std::optional<Vec3> pick_plane_image(const VolumeView& view, const Camera& camera,
                                                   const PictureArea& area, double x, double y);

}  // namespace palpate
