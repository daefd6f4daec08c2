/// How a mouse moves a probe: in the plane of the view, along it with the wheel, on one axis if locked. Plain
/// arithmetic, no window.
#pragma once

#include <optional>

#include "common/render/camera.h"

namespace palpate {

/// A place on the picture, in pixels from its top left corner.
struct PicturePoint {
  double x = 0.0;
  double y = 0.0;
};

/// Size of the picture [pixels].
struct PictureSize {
  int width = 1;
  int height = 1;
};

/// Where `from` goes when it is dragged by (dx, dy) pixels: it stays under the mouse, in the plane through it
/// that the camera faces. With a locked axis it stays on that axis, as near to the mouse as it can.
/// @param axis 0, 1, 2.
[[nodiscard]] Vec3 dragged(const Camera& camera, const PictureSize& size, const Vec3& from, double dx,
                           double dy, std::optional<int> axis);

/// Where `from` goes by `notches` of the wheel: away from the viewer for positive ones, by a fiftieth of the
/// view's height each; with a locked axis along that, to the side that is away from the viewer.
[[nodiscard]] Vec3 pushed(const Camera& camera, const Vec3& from, double notches, std::optional<int> axis);

/// The point that is drawn where `x` is, at the depth of `depth_of`. `x` itself where either is behind the
/// eye.
[[nodiscard]] Vec3 at_depth_of(const Camera& camera, const Vec3& x, const Vec3& depth_of);

/// The point under the mouse in the plane through `depth_of` that the camera faces.
[[nodiscard]] Vec3 under_mouse(const Camera& camera, const PictureSize& size, const PicturePoint& mouse,
                               const Vec3& depth_of);

}  // namespace palpate
