/// One cell into tetrahedra, so that both cells beside a face cut it alike.
///
/// Every face of more than three vertices is cut by the diagonals through its vertex of the smallest key,
/// and the cell is coned from its vertex of the smallest key over the triangles of the faces that do not hold
/// it (Dompierre et al. 1999).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/field/grid/cell_faces.h"
#include "common/field/grid/tet_mesh.h"

namespace palpate {

/// Appends to a list of tetrahedra; those with a repeated vertex are left out. None is oriented.
class CellCone {
 public:
  /// @param odd for each point, whether it comes after those that are not odd. Both outlive this.
  CellCone(std::span<const std::uint8_t> odd, std::vector<TetMesh::Tet>& tets) : odd_(odd), tets_(tets) {}

  void tetrahedron(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);

  /// The cell with these outward faces.
  void cell(const FaceList& faces);

  /// A hexahedron whose eight vertices differ. Where no diagonal of the faces away from the smallest vertex
  /// meets the vertex opposite to it, five tetrahedra do; else the cone's six.
  void hexahedron(const std::array<std::uint32_t, 8>& v);

 private:
  /// Order of vertices that both cells beside a face see: even points of structured blocks first.
  [[nodiscard]] std::uint64_t key(std::uint32_t id) const {
    return (static_cast<std::uint64_t>(odd_[id]) << 32U) | id;
  }
  [[nodiscard]] std::size_t least(std::span<const std::uint32_t> ids) const;

  std::span<const std::uint8_t> odd_;
  std::vector<TetMesh::Tet>& tets_;
  FaceList faces_;                   ///< scratch
  std::vector<std::uint32_t> face_;  ///< scratch
};

}  // namespace palpate
