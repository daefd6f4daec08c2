/// The border of a tetrahedral mesh, parted at its creases.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "common/field/grid/tet_mesh.h"

namespace palpate {

/// Faces of cells that have no neighbour. Faces of zero-volume cells are border like any others.
struct WallBorder {
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< points of the mesh, the normal outwards
  std::vector<Vec3> areas;                              ///< normals as long as the triangle's area, frame L
  std::vector<CellIndex> cells;                         ///< behind each triangle
  std::vector<std::uint8_t> faces;                      ///< which face of it: across from that corner
  std::vector<std::pair<std::uint32_t, std::uint32_t>> joints;  ///< triangles that share an edge

  /// The normal, of unit length; zero where the triangle has no area.
  [[nodiscard]] Vec3 normal(std::size_t triangle) const;
};
[[nodiscard]] inline Vec3 triangle_middle(std::span<const Vec3> points,
                                          const std::array<std::uint32_t, 3>& triangle) noexcept {
  return (points[triangle[0]] + points[triangle[1]] + points[triangle[2]]) / 3.0;
}
[[nodiscard]] WallBorder border_of(const TetMesh& mesh);

/// A smooth part of the border.
struct BorderPart {
  std::vector<std::uint32_t> triangles;
  double area = 0.0;
  /// The sum of the triangles' normals over `area`: of unit length where the part is flat, short where it
  /// goes round.
  Vec3 normal{0.0};
  Box bounds;
  /// Between the part and the middle of its rim, over the cube of its area's root: 0 for what is flat or a
  /// saddle, 0.13 for half a sphere whose normals point away from its middle, below zero where they point
  /// to it.
  double bulge = 0.0;

  [[nodiscard]] bool flat() const { return glm::length(normal) > kFlat; }
  static constexpr double kFlat = 0.99;  ///< all of a part faces one way within some 8 degrees
};

/// Triangles belong to one part where their normals differ by less than `crease` [rad] over the edge that
/// they share. Parts by falling area; all lengths in frame L.
[[nodiscard]] std::vector<BorderPart> border_parts(const TetMesh& mesh, const WallBorder& border,
                                                   double crease);
/// The same by what `one` says of two triangles that share an edge.
[[nodiscard]] std::vector<BorderPart> border_parts(const TetMesh& mesh, const WallBorder& border,
                                                   const std::function<bool(std::size_t, std::size_t)>& one);

/// Where a straight way through the cells, from the middle of a triangle against its normal, leaves them: a
/// triangle of the border, or the border's count where it is lost.
class WallCrossing {
 public:
  WallCrossing(const TetMesh& mesh, const WallBorder& border);
  [[nodiscard]] std::size_t from(std::size_t triangle) const;

 private:
  const TetMesh& mesh_;
  const WallBorder& border_;
  std::vector<std::uint32_t> triangle_of_;  ///< of each face of each cell
};

}  // namespace palpate
