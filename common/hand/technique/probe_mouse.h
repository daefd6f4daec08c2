/// How a mouse moves a probe: in the plane of the view, along it with the wheel, on one axis if locked. Plain
/// arithmetic, no window.
#pragma once

#include <optional>

#include "common/field/scalar_field.h"
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

// How a mouse leads a probe along a surface that holds it. Dragged in the plane of the view the probe would
// soon leave a wall that bends away, and cross other layers on its way: it goes to the surface under the
// mouse instead, and stays as far before or behind that as the wheel has pushed it.

/// An isosurface, and the point of it that holds the probe; data coordinates and values.
struct HeldSurface {
  const ScalarField& field;
  double level = 0.0;
  Vec3 proxy{0.0};
};

/// Where a probe goes that a mouse drags from `from` to `to`, both about as far from the viewer: on the line
/// of sight through `to`, as far beyond the surface there as `from` is beyond it on its own line of sight. Of
/// several places of the surface along a line the one next to it counts, on the side of the proxy: where the
/// surface turns its other side to the viewer it is another one. Nothing where a line of sight meets the
/// surface nowhere near: beyond a contour, or where the wall ends.
[[nodiscard]] std::optional<Vec3> dragged_along(const HeldSurface& surface, const Camera& camera,
                                                const Vec3& from, const Vec3& to);

}  // namespace palpate
