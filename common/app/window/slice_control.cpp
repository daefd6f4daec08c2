#include "common/app/window/slice_control.h"

#include <cmath>

namespace palpate {
namespace {

constexpr int kLeftControlKey = 341, kRightControlKey = 345;  // GLFW's numbers

/// Moves the slice across axis 0, 1 or 2 of the data by one voxel, toward larger coordinates for `steps` > 0.
void step_along(TensorView& view, std::size_t axis, int steps) {
  const TensorVoxels& voxels = *view.image;
  const int own = slice_axes(voxels.axes)[axis];
  const bool forwards = voxels.axes[own][static_cast<int>(axis)] > 0.0;
  view.position = moved_position(voxels, view.position, own, forwards ? steps : -steps);
}

/// The slice that is shown and faces the viewer most.
std::optional<int> facing_slice(const TensorView& view, const Camera& camera) {
  std::optional<int> best;
  double most = -1.0;
  for (int axis = 0; axis < 3; ++axis) {
    if (!view.slices[static_cast<std::size_t>(axis)]) continue;
    const Vec3 normal = glm::normalize(glm::cross(glm::normalize(view.image->axes[(axis + 1) % 3]),
                                                  glm::normalize(view.image->axes[(axis + 2) % 3])));
    const double facing = std::abs(glm::dot(normal, camera.axes[2]));
    if (facing > most) {
      most = facing;
      best = axis;
    }
  }
  return best;
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
      return dragging_;
    case InputKind::kPress:
      if (!control_ || event.button != MouseButton::kLeft || !area.contains(x_, y_)) return false;
      dragging_ = true;
      put_crosshair();
      return true;
    case InputKind::kRelease:
      if (!dragging_ || event.button != MouseButton::kLeft) return false;
      dragging_ = false;
      return true;
    case InputKind::kWheel: {
      if (!control_ || event.y == 0.0 || !area.contains(x_, y_)) return false;
      const auto pick = under_mouse(area, camera, view);
      const std::optional<int> axis = pick ? std::optional(pick->axis) : facing_slice(view, camera);
      if (!axis) return false;
      // Away from the viewer for positive notches.
      const bool away = glm::dot(view.image->axes[*axis], camera.axes[2]) < 0.0;
      const int notch = event.y > 0.0 ? 1 : -1;
      view.position = moved_position(*view.image, view.position, *axis, away ? notch : -notch);
      return true;
    }
    case InputKind::kKeyDown:
    case InputKind::kKeyUp:
      if (event.key == kLeftControlKey || event.key == kRightControlKey)
        control_ = event.kind == InputKind::kKeyDown;
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

}  // namespace palpate
