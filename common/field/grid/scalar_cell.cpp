#include "common/field/grid/scalar_cell.h"

#include <cmath>
#include <cstddef>

#include "common/base/check.h"
#include "common/base/index.h"

namespace palpate {

namespace {

// The coefficients of (1) from the values read(x, y, z) at the corners.
template <typename Read>
void set_coefficients(const Read& read, std::array<double, 8>& c) noexcept {
  const double s000 = read(0, 0, 0), s100 = read(1, 0, 0), s010 = read(0, 1, 0), s110 = read(1, 1, 0);
  const double s001 = read(0, 0, 1), s101 = read(1, 0, 1), s011 = read(0, 1, 1), s111 = read(1, 1, 1);
  // Differences along x on the four edges, then along y, then along z.
  const double x00 = s100 - s000, x10 = s110 - s010, x01 = s101 - s001, x11 = s111 - s011;
  const double y0 = s010 - s000, y1 = s011 - s001;
  const double xy0 = x10 - x00, xy1 = x11 - x01;
  c = {s000, x00, y0, s001 - s000, xy0, y1 - y0, x01 - x00, xy1 - xy0};
}

}  // namespace

void load_scalar_cell(const BoxGrid& grid, const PointScalars& values, const Index3& cell,
                      ScalarBoxCell& out) noexcept {
  const Index3& n = grid.points();
  PALPATE_ASSERT(cell.x >= 0 && cell.y >= 0 && cell.z >= 0);
  PALPATE_ASSERT(cell.x < n.x - 1 && cell.y < n.y - 1 && cell.z < n.z - 1);
  if (const auto* sparse = std::get_if<SparseSpan>(&values.values)) {
    // Corners share blocks, mostly one.
    SparseReader reader(*sparse->numbers);
    set_coefficients(
        [&](int x, int y, int z) {
          return static_cast<double>(reader.at(cell + Index3(x, y, z))) * values.scale;
        },
        out.c);
  } else {
    const auto row = as_size(n.x);
    const std::size_t slice = row * as_size(n.y);
    const std::size_t first = as_size(cell.x) + row * as_size(cell.y) + slice * as_size(cell.z);
    std::visit(
        [&](const auto& stored) {
          set_coefficients(
              [&](int x, int y, int z) {
                return static_cast<double>(
                           stored[first + as_size(x) + (y != 0 ? row : 0) + (z != 0 ? slice : 0)]) *
                       values.scale;
              },
              out.c);
        },
        values.values);
  }
  // c_xyz is a sum over all corners: finite if and only if they all are.
  out.bad_data = !std::isfinite(out.c[7]) || grid.hidden(cell);
  out.index = cell;
  for (int axis = 0; axis < 3; ++axis) {
    out.lower[axis] = grid.coordinate(axis, cell[axis]);
    out.upper[axis] = grid.coordinate(axis, cell[axis] + 1);
  }
  out.inverse_size = 1.0 / (out.upper - out.lower);
}

ScalarTet load_scalar_tet(const PointScalars& values, const TetMesh::Tet& tet) noexcept {
  ScalarTet out;
  std::visit(
      [&](const auto& stored) {
        for (int i = 0; i < 4; ++i) {
          out.s[i] = static_cast<double>(stored[tet[as_size(i)]]) * values.scale;
        }
      },
      values.values);
  out.bad_data = !std::isfinite(out.s[0] + out.s[1] + out.s[2] + out.s[3]);
  return out;
}

}  // namespace palpate
