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
  /// that it leaves. The jump between cells of constant velocity is the field's own, and what comes of it is exact; not so
  /// where blocks overlap.
  double error = 0.0;
  /// Cells of constant velocity: what becomes of an error e is e + jump * (lever . e): who is off reaches the face at
  /// another time.
  Vec3 jump{0.0}, lever{0.0};
  double longest = 0.0;  ///< that the jump makes of an error: a face
  /// Cells of constant velocity that both point at the face: there is nowhere to go.
  bool opposed = false;

  /// An error of the line before the crossing as it is behind it.
  [[nodiscard]] Vec3 carried(const Vec3& e) const noexcept;
};

/// Crosses border face `face` of `from` at x. `sign` is that of the direction, `stuck` the crossings before this
/// one since the line moved. Where the flow on either side, not constant over its cell, points at the seam, a line that is stuck is put 2^-10
/// of the cell behind it: it goes along the seam from there, to and fro. Frame L.
[[nodiscard]] SeamCrossing cross_seam(const ExactMesh& mesh, CellIndex from, int face, const Vec3& x,
                                      double sign, int stuck);

}  // namespace palpate
