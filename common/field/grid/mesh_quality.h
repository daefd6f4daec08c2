/// How good tetrahedra are: volume, angles, what is joined to what.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "common/field/grid/tet_mesh.h"

namespace palpate {

/// A tetrahedron with a dihedral angle below, or above 180 degrees less this, counts as a sliver.
inline constexpr double kSliverAngle = 5.0;

struct MeshQuality {
  std::size_t points = 0;  ///< that some cell uses
  std::size_t cells = 0;
  double volume = 0.0;  ///< of all cells, frame of the mesh
  /// Cells by their smallest and largest dihedral angle, in steps of 10 degrees.
  std::array<std::size_t, 18> least_angles{}, largest_angles{};
  double least_angle = 180.0;         ///< [degrees] of all dihedral angles; zero-volume cells left out
  double largest_angle = 0.0;         ///< likewise
  std::size_t slivers = 0;            ///< zero-volume cells included
  std::size_t zero_volume = 0;        ///< TetMesh::zero_volume_count()
  std::size_t components = 0;         ///< parts that no face joins
  std::size_t largest_component = 0;  ///< cells of the largest one
  std::size_t border_faces = 0;
  std::size_t open_edges = 0;       ///< of the border: with an odd number of faces
  std::size_t manifold_faults = 0;  ///< edges with more than two border faces
  std::size_t folded_faces = 0;     ///< with both their cells on one side: these overlap
};

[[nodiscard]] MeshQuality mesh_quality(const TetMesh& mesh);

/// Faces with cells on one side of them, which overlap: cells that were turned, and TetMesh::overlapping_face_count().
[[nodiscard]] std::size_t folded_faces(const TetMesh& mesh);

/// The six dihedral angles of a tetrahedron [degrees], in no particular order; NaN where a face has no area.
[[nodiscard]] std::array<double, 6> dihedral_angles(const std::array<Vec3, 4>& corners) noexcept;

}  // namespace palpate
