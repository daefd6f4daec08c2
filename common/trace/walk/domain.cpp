#include "common/trace/walk/domain.h"

#include "common/base/index.h"
#include "common/trace/walk/tet_crossing.h"

namespace palpate {

bool TetDomain::locate(const Vec3& x) {
  TetPoint found;
  if (!mesh_->mesh().locate(x, kNoCell, found)) return false;
  load(found.cell);
  return true;
}

void TetDomain::load(CellIndex cell) {
  cell_ = cell;
  AffineCell affine;
  const TetMesh::Tet& tet = mesh_->mesh().cells()[as_size(cell)];
  bad_ = !load_cell(affine, mesh_->vertices(), tet.data(), sign_);
  const PackedVertex& corner = mesh_->vertices()[tet[3]];
  corner_ = Pack4::load(corner.x);
  origin_ = sign_ * Pack4{corner.v[0], corner.v[1], corner.v[2], 0.0};
  Mat3 gradient{0.0};
  for (int j = 0; j < 3; ++j) {
    const Vec3 g = barycentric_gradient(affine, j);
    const Pack4 dv = sign_ * (Pack4::load(mesh_->vertices()[tet[as_size(j)]].v) - Pack4::load(corner.v));
    for (int axis = 0; axis < 3; ++axis) gradient[axis] += g[axis] * dv.xyz();
    face_[as_size(j)] = g;
  }
  for (int axis = 0; axis < 3; ++axis) gradient_.column[as_size(axis)] = Pack4{gradient[axis], 0.0};
  face_[3] = -(face_[0] + face_[1] + face_[2]);
  face_offset_ = {0.0, 0.0, 0.0, 1.0};
  size_ = affine.size;
}

bool TetDomain::cross(int face, Pack4& y, int& entry) {
  const TetMesh& mesh = mesh_->mesh();
  const CellIndex from = cell_;
  const CellIndex next = mesh.neighbors()[as_size(from)][as_size(face)];
  if (next == kNoCell) return false;
  if (mesh.zero_volume(next)) {
    const CellIndex beyond = sound_cell_beyond(mesh, next, from, y.xyz());
    if (beyond == kNoCell) return false;
    load(beyond);
    entry = -1;
    return true;
  }
  const TetMesh::Neighbors& back = mesh.neighbors()[as_size(next)];
  entry = -1;
  for (int i = 0; i < 4; ++i) {
    if (back[as_size(i)] == from) entry = i;
  }
  load(next);
  return true;
}

}  // namespace palpate
