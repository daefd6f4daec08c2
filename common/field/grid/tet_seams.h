/// Where cells lie behind the border faces of a mesh though they share no points: cells with points of their own,
/// hanging nodes, blocks that meet shifted or overlap.
#pragma once

#include <cstddef>

#include "common/field/grid/tet_mesh.h"

namespace palpate {

struct FaceNormal {
  Vec3 outward{0.0};  ///< unit; 0 where the face has no area
  double size = 0.0;  ///< longest edge of the face
};
[[nodiscard]] FaceNormal face_normal(const TetMesh& mesh, CellIndex cell, int face) noexcept;

struct CellBehind {
  CellIndex cell = kNoCell;
  double step = 0.0;  ///< behind the face, as a part of it, that led there
};

/// What lies behind border face `face` of `cell` at x, a point of that face: the cell that location finds a small
/// step behind it, 2^-20 of the face, then 2^-10 and 2^-6, for gaps. kNoCell where the domain ends,
/// and at closed faces. @rt Safe.
[[nodiscard]] CellBehind cell_behind(const TetMesh& mesh, CellIndex cell, int face, const Vec3& x) noexcept;

struct Seams {
  std::size_t border_faces = 0;
  std::size_t faces = 0;        ///< of these, with a cell behind their middle
  std::size_t over_gaps = 0;    ///< of these, found by more than the smallest step
  std::size_t overlapping = 0;  ///< of these, farther within that cell than at its border
};
[[nodiscard]] Seams find_seams(const TetMesh& mesh, int threads);

}  // namespace palpate
