/// How long the ways along the gradient of a potential are, from each point of a mesh to where it begins or ends.
///
///   L(x) = |x - q| + L(q),   L = 0 where the potential is lowest (or highest)                            (1)
///
/// with q where the straight way from x along the gradient leaves the cell that it enters, and L(q) interpolated
/// on that face: Yezzi and Prince, IEEE Trans Med Imaging 22 (2003) 1332, on tetrahedra and semi-Lagrangian in
/// place of upwind differences. First order in the length of the edges. Both ways together are the length of a
/// field line: between the surfaces of a wall its thickness.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/field/grid/tet_mesh.h"

namespace palpate {

/// The cells of some volume at each point: `cells[begin[p]]` to `cells[begin[p + 1]]`, by rising number.
struct CellsOfPoints {
  std::vector<std::size_t> begin;
  std::vector<std::uint32_t> cells;
};
[[nodiscard]] CellsOfPoints cells_of_points(const TetMesh& mesh);

/// At each point the volume-weighted mean of the directions of the gradient in the cells around: of unit length
/// where all agree, zero where there is none. Values that are NaN take no part. Frame L.
[[nodiscard]] std::vector<Vec3> gradient_directions(const TetMesh& mesh, std::span<const double> values);

enum class WayAlong : std::uint8_t { kFalling, kRising };

/// (1), frame L; NaN at points whose potential is NaN or from which no way leads on.
[[nodiscard]] std::vector<double> way_lengths(const TetMesh& mesh, std::span<const double> potential,
                                              WayAlong along);

}  // namespace palpate
