#include "common/window/controls/slice_control.h"

#include <cmath>
#include <utility>

#include "common/window/keys.h"

namespace palpate {
namespace {

/// Moves the slice across axis 0, 1 or 2 of the data by one voxel, toward larger coordinates for `steps` > 0.
void step_along(TensorView& view, std::size_t axis, int steps) {
  const TensorVoxels& voxels = *view.image;
  const int own = slice_axes(voxels.axes)[axis];
  const bool forwards = voxels.axes[own][static_cast<int>(axis)] > 0.0;
  view.position = moved_position(voxels, view.position, own, forwards ? steps : -steps);
}

}  // namespace

std::optional<TensorPick> SliceControl::under_mouse(const PictureArea& area, const Camera& camera,
                                                    const TensorView& view) const {
  if (!area.contains(x_, y_)) return std::nullopt;
  return pick_slice(view, camera, static_cast<int>(area.width), static_cast<int>(area.height), x_ - area.left,
                    y_ - area.top);
}

bool SliceControl::handle(const InputEvent& event, const PictureArea& area, const Camera& camera,
                          TensorView& view) {
  const auto put_crosshair = [&] {
    if (const auto pick = under_mouse(area, camera, view)) view.position = pick->position;
  };
  switch (event.kind) {
    case InputKind::kMove:
      x_ = event.x;
      y_ = event.y;
      if (dragging_) put_crosshair();
      if (std::hypot(x_ - pressed_x_, y_ - pressed_y_) > kDragDistance) clicking_ = false;
      return dragging_;
    case InputKind::kPress:
      clicking_ = event.button == MouseButton::kLeft && area.contains(x_, y_);
      pressed_x_ = x_;
      pressed_y_ = y_;
      if (!control_ || !clicking_) return false;
      dragging_ = true;
      put_crosshair();
      return true;
    case InputKind::kRelease:
      if (event.button != MouseButton::kLeft) return false;
      if (std::exchange(dragging_, false)) return true;
      if (std::exchange(clicking_, false)) put_crosshair();
      return false;  // the camera's drag ends, too
    case InputKind::kWheel: {
      if (control_ || event.y == 0.0) return false;
      const auto pick = under_mouse(area, camera, view);
      if (!pick) return false;
      // Away from the viewer for positive notches.
      const bool away = glm::dot(view.image->axes[pick->axis], camera.axes[2]) < 0.0;
      const int notch = event.y > 0.0 ? 1 : -1;
      view.position = moved_position(*view.image, view.position, pick->axis, away ? notch : -notch);
      return true;
    }
    case InputKind::kKeyDown:
    case InputKind::kKeyUp:
      if (is_control_key(event.key)) control_ = event.kind == InputKind::kKeyDown;
      return false;
    default:
      return false;
  }
}

bool SliceControl::run(Command command, TensorView& view) {
  switch (command) {
    case Command::kSliceRight:
      step_along(view, 0, 1);
      return true;
    case Command::kSliceLeft:
      step_along(view, 0, -1);
      return true;
    case Command::kSliceFront:
      step_along(view, 1, 1);
      return true;
    case Command::kSliceBack:
      step_along(view, 1, -1);
      return true;
    case Command::kSliceUp:
      step_along(view, 2, 1);
      return true;
    case Command::kSliceDown:
      step_along(view, 2, -1);
      return true;
    default:
      return false;
  }
}

void CrosshairLink::follow(SceneView& view) {
  if (!view.volume || !view.tensors) return;
  Vec3 &cross = view.volume->panes.cross, &place = view.tensors->position;
  if (view.volume->panes.layout > 1 && cross != place) {
    const TensorVoxels& voxels = *view.tensors->image;
    if (cross != last_ && voxels.contains(voxels.grid_coordinates(cross))) {
      place = cross;
    } else {
      cross = place;
    }
  }
  last_ = cross;
}

}  // namespace palpate
