/// Lines of equal value on a surface of triangles (isosurface_mesh.h), by marching triangles.
///
/// A line crosses an edge where the linear course between its ends has the value: exactly there on the layers
/// of tetrahedra for what is linear in these, since each edge of such a layer lies in a tetrahedron's face.
/// Through a triangle it runs straight. A corner with the very value counts as above, so that a line never
/// branches at it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/trace/isosurface/isosurface_mesh.h"

namespace palpate {

/// A place on an edge of the surface.
struct EdgePoint {
  std::uint32_t below = 0, above = 0;  ///< its ends
  double part = 0.0;                   ///< of the way from `below` to `above`, 0 to 1
  Vec3 position{0.0};                  ///< data coordinates
};

/// From border to border, or closed: then its first point is its last one, too.
using SurfaceContour = std::vector<EdgePoint>;

/// The lines where `above` is zero, in an order that depends on the mesh alone.
/// @param above at the points of the mesh: value less the one that is sought. Triangles with one that is not
/// finite are left out.
/// @param most edges along which it changes by as much are left out with their triangles: where a value goes
/// round, as an angle does, that is no crossing. Infinity: none.
/// @pre as many values as points.
[[nodiscard]] std::vector<SurfaceContour> surface_contours(const IsosurfaceMesh& mesh,
                                                           std::span<const double> above, double most);

}  // namespace palpate
