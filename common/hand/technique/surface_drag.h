/// How a mouse leads a probe along a surface that holds it. Dragged in the plane of the view the probe would
/// soon leave a wall that bends away, and cross other layers on its way: it goes to the surface under the
/// mouse instead, and stays as far before or behind that as the wheel has pushed it.
#pragma once

#include <optional>

#include "common/field/scalar_field.h"
#include "common/render/camera.h"

namespace palpate {

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
