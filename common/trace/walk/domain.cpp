#include "common/trace/walk/domain.h"

#include <cmath>
#include <variant>

#include "common/base/index.h"
#include "common/field/field_grid.h"
#include "common/field/rest_speed.h"
#include "common/ode/linear_step.h"

namespace palpate {

TetDomain::TetDomain(const ExactMesh& mesh, double sign) : mesh_(&mesh), sign_(sign) {}

BoxDomain::BoxDomain(const VectorField& field, double sign)
    : grid_(field.box_grid()),
      values_(&field.values()),
      sign_(sign),
      value_rounding_(field.value_rounding()),
      point_rounding_(field.grid() ? field.grid()->point_rounding / field.frame().length_scale() : 0.0) {
  rest_speed_ = std::visit(
      [&](const auto& stored) {
        return palpate::rest_speed(stored.size() / 3, [&](std::size_t i) {
          return values_->scale * std::hypot(static_cast<double>(stored[3 * i]),
                                             static_cast<double>(stored[3 * i + 1]),
                                             static_cast<double>(stored[3 * i + 2]));
        });
      },
      values_->values);
}

BoxDomain::Corners BoxDomain::corners_of(const BoxCell& cell) {
  std::array<Pack4, 8> c;
  for (std::size_t k = 0; k < 8; ++k) c[k] = Pack4{cell.c[k], 0.0};
  const Pack4 x = c[0] + c[1], xy = x + (c[2] + c[4]), up_x = c[3] + c[6];
  Corners out{c[0], x, c[0] + c[2], xy};
  const std::array<Pack4, 4> up{c[3], up_x, c[3] + c[5], up_x + (c[5] + c[7])};
  for (std::size_t k = 0; k < 4; ++k) out[k + 4] = out[k] + up[k];
  return out;
}

unsigned BoxDomain::slow_ones(const Corners& corners) const {
  constexpr unsigned kAxes = 0b111u;
  const Pack4 rest = Pack4::all(rest_speed_);
  unsigned slow = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Pack4& v = corners[corner];
    if ((bits(abs(v) <= rest) & kAxes) == kAxes && dot3(v, v) <= rest_speed_ * rest_speed_)
      slow |= 1U << corner;
  }
  return slow;
}

/// Once a cell: what this costs in each step would be seen.
double BoxDomain::error_of_data(const BoxCell& cell, const Corners& corners) const {
  double error = 0.0;
  if (value_rounding_ > 0.0) {
    Pack4 fastest = abs(corners[0]);
    for (std::size_t k = 1; k < 8; ++k) fastest = max(fastest, abs(corners[k]));
    error = value_rounding_ * std::sqrt(dot3(fastest, fastest));
  }
  if (point_rounding_ > 0.0) {
    // The largest row sum of the Jacobian's greatest entries, times d.
    constexpr std::array<std::array<std::size_t, 4>, 3> kAlong{{{1, 4, 6, 7}, {2, 4, 5, 7}, {3, 5, 6, 7}}};
    Pack4 rows;
    for (int axis = 0; axis < 3; ++axis) {
      for (const std::size_t k : kAlong[as_size(axis)])
        rows += cell.inverse_size[axis] * abs(Pack4{cell.c[k], 0.0});
    }
    error += point_rounding_ * max_lane(rows);
  }
  return error;
}

// Seldom more than a look at `slow`: most cells have no slow corner.
bool BoxDomain::has_resting_corner(unsigned slow) const {
  constexpr unsigned kAll = 0xFF;
  if (slow == 0 || slow == kAll) return slow == kAll;
  const Index3 cells = grid_->points() - 1;
  BoxCell beside;
  for (unsigned corner = 0; corner < 8; ++corner) {
    if ((slow >> corner & 1U) == 0) continue;
    const Index3 last =
        index_ + Index3(corner & 1U, corner >> 1U & 1U, corner >> 2U);  // of the cells around it
    for (unsigned i = 0; i < 8; ++i) {
      const Index3 at = last - Index3(i & 1U, i >> 1U & 1U, i >> 2U);
      if (at == index_ || at.x < 0 || at.y < 0 || at.z < 0 || at.x >= cells.x || at.y >= cells.y ||
          at.z >= cells.z)
        continue;
      grid_->load(at, *values_, beside);
      if (slow_ones(corners_of(beside)) == kAll) return true;
    }
  }
  return false;
}

bool TetDomain::locate(const Vec3& x) {
  TetPoint found;
  if (!mesh_->mesh().locate(x, kNoCell, found)) return false;
  // The walk may have been another line's.
  stuck_ = 0;
  last_seam_ = Vec3{HUGE_VAL};
  crossed_seam_ = false;
  seam_ = {};
  load(found.cell);
  return true;
}

void TetDomain::restore(StateReader& in) {
  CellIndex cell = kNoCell;
  in(cell, crossed_seam_, seam_, stuck_, last_seam_);
  load(cell);
}

void TetDomain::load(CellIndex cell) {
  cell_ = cell;
  AffineCell affine;
  const TetMesh::Tet& tet = mesh_->mesh().cells()[as_size(cell)];
  bad_ = !load_cell(affine, mesh_->vertices(), tet.data(), sign_);
  rest_here_ = 0.0;
  double fastest = 0.0;  // its square
  for (const std::uint32_t i : tet) {
    if (mesh_->rests(i)) rest_here_ = mesh_->rest_speed();
    const double* const v = mesh_->vertices()[i].v;
    fastest = std::max(fastest, v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  }
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
  data_error_ = mesh_->value_error() + mesh_->value_rounding() * std::sqrt(fastest) +
                mesh_->point_rounding() * LinearStep::row_sum(gradient);
  face_[3] = -(face_[0] + face_[1] + face_[2]);
  face_offset_ = {0.0, 0.0, 0.0, 1.0};
  size_ = affine.size;
}

bool TetDomain::cross(int face, Pack4& y, int& entry) {
  const TetMesh& mesh = mesh_->mesh();
  const CellIndex from = cell_;
  const CellIndex next = mesh.neighbors()[as_size(from)][as_size(face)];
  crossed_seam_ = false;
  if (next == kNoCell) return cross_border(face, y, entry);
  if (mesh.zero_volume(next)) {
    const CellIndex beyond = sound_cell_beyond(mesh, next, from, y.xyz());
    if (beyond == kNoCell) return cross_border(face, y, entry);
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

bool TetDomain::cross_border(int face, Pack4& y, int& entry) {
  const Vec3 x = y.xyz();
  constexpr double kMoved = 1e-12;  // of the cell
  stuck_ = glm::distance(x, last_seam_) <= kMoved * size_ ? stuck_ + 1 : 0;
  seam_ = cross_seam(*mesh_, cell_, face, x, sign_, stuck_);
  if (seam_.cell == kNoCell || seam_.opposed) return false;
  crossed_seam_ = true;
  entry = -1;
  load(seam_.cell);
  last_seam_ = seam_.x;
  y = Pack4{last_seam_, y[3]};
  return true;
}

}  // namespace palpate
