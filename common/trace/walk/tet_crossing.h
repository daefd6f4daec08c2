/// Going from one tetrahedron to the next where zero-volume cells lie between, or where they share no points.
#pragma once

#include "common/field/grid/tet_mesh.h"
#include "common/trace/exact/exact_mesh.h"

namespace palpate {

/// The cell of positive volume beyond the cluster of zero-volume cells around `flat` that holds `x` best;
/// kNoCell where none does (the mesh ends there). `from` is the cell that the line comes from; cells on its
/// side of the face are taken only where there is no other.
[[nodiscard]] CellIndex sound_cell_beyond(const TetMesh& mesh, CellIndex flat, CellIndex from, const Vec3& x);

/// Where a line goes on behind a border face of its cell.
struct SeamCrossing {
  CellIndex cell = kNoCell;  ///< kNoCell: the domain ends there
  Vec3 x{0.0};               ///< in the cell
  Vec3 v{0.0};               ///< the velocity there
  /// Distance that the line may be off for it: the gap, and the jump of the velocity as an angle, over the cell
  /// that it leaves.
  double error = 0.0;
};

/// Crosses border face `face` of `from` at x. `sign` is that of the direction, `stuck` the crossings before this
/// one since the line moved. Where the flow on either side points at the seam, a line that is stuck is put 2^-10
/// of the cell behind it: it goes along the seam from there, to and fro. Frame L.
[[nodiscard]] SeamCrossing cross_seam(const ExactMesh& mesh, CellIndex from, int face, const Vec3& x,
                                      double sign, int stuck);

}  // namespace palpate
