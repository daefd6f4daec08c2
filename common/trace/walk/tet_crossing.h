/// Going from one tetrahedron to the next where zero-volume cells lie between.
#pragma once

#include "common/field/grid/tet_mesh.h"

namespace palpate {

/// The cell of positive volume beyond the cluster of zero-volume cells around `flat` that holds `x` best;
/// kNoCell where none does (the mesh ends there). `from` is the cell that the line comes from; cells on its
/// side of the face are taken only where there is no other.
[[nodiscard]] CellIndex sound_cell_beyond(const TetMesh& mesh, CellIndex flat, CellIndex from, const Vec3& x);

}  // namespace palpate
