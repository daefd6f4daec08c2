/// Which tetrahedra of a triangulated point set belong to the wall whose points they join. A Delaunay
/// triangulation fills the convex hull: cavities, and what lies between wall and hull, too.
///
/// The rule: a tetrahedron belongs to the wall where its centroid lies in a cell of the sampled wall. Where
/// one cell has all four corners, it does without a further look. What cannot be told apart so is the space
/// between the curved surface and the faces of cells, second order in the sampling like the faces themselves.
///
/// Then slivers at the border are taken off: tetrahedra whose least height is below kSliver of their longest
/// edge, with two faces on the border that meet in an edge, where the opposite edge is not a border one. Four
/// points of a curved quadrilateral of the surface make such a one; taking it off replaces one diagonal of
/// that quadrilateral by the other, so that no hole and no double edge comes of it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "apps/cardiac/mesher/delaunay.h"
#include "common/scene/wall/mesh_job.h"

namespace palpate {

inline constexpr double kSliver = 0.03;
/// Last, parts of less than this of all tetrahedra that no face joins to the rest are left out.
inline constexpr double kIsland = 1e-3;

/// Looks up cells of a sampled wall.
class WallCells {
 public:
  explicit WallCells(const SampledWall& wall);

  /// Whether one cell has all four corners.
  [[nodiscard]] bool share_cell(const TetMesh::Tet& tet) const noexcept;
  /// Whether `x` lies in a cell or on its border.
  [[nodiscard]] bool hold(const Vec3& x) const noexcept;

 private:
  [[nodiscard]] bool cell_holds(std::size_t cell, const Vec3& x) const noexcept;
  [[nodiscard]] std::array<std::int64_t, 3> bin_of(const Vec3& x) const noexcept;
  void make_bins();

  const SampledWall& wall_;
  std::vector<std::uint32_t> first_tet_;      ///< of each cell, and the count
  std::vector<std::uint32_t> first_cell_;     ///< of each point, in cells_of_point_
  std::vector<std::uint32_t> cell_of_point_;  ///< rising for each point
  Box bounds_;
  std::array<std::int64_t, 3> bins_{1, 1, 1};
  Vec3 per_length_{0.0};
  std::vector<std::uint32_t> first_in_bin_;
  std::vector<std::uint32_t> in_bin_;
};

/// The distance of each point from the nearest one that a tetrahedron joins it to; 1 for points of none.
[[nodiscard]] std::vector<double> point_spacing(const SampledWall& wall);

/// @param cells of a triangulation of the wall's points; its memory is let go of as it is read.
/// @return tetrahedra in the order of `cells`, with counts; no points.
[[nodiscard]] FinishedMesh choose_wall(const SampledWall& wall, DelaunayCells cells);

}  // namespace palpate
