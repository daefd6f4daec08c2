#include "common/trace/exact/exact_cell.h"

namespace palpate {
inline namespace PALPATE_PACK {

bool load_cell(AffineCell& cell, const PackedVertex* vertices, const std::uint32_t* tet,
               double sign) noexcept {
  const PackedVertex* const at[4] = {&vertices[tet[0]], &vertices[tet[1]], &vertices[tet[2]],
                                     &vertices[tet[3]]};
  const Pack4 x3 = Pack4::load(at[3]->x);
  x3.store(cell.corner);
  for (int i = 0; i < 3; ++i) (Pack4::load(at[i]->x) - x3).store(cell.edge[i]);

  // Face i has the normal n_i = s_i x t_i with edges s, t; n_3 closes the tetrahedron: minus the sum of the
  // others.
  Pack4 s[3], t[3], extent;
  for (int axis = 0; axis < 3; ++axis) {
    const Pack4 x{at[0]->x[axis], at[1]->x[axis], at[2]->x[axis], at[3]->x[axis]};
    const Pack4 from = lanes<3, 3, 3, 0>(x);
    s[axis] = lanes<1, 2, 0, 2>(x) - from;
    t[axis] = lanes<2, 0, 1, 1>(x) - from;
    extent += abs(s[axis]);
  }
  const Pack4 n[3] = {s[1] * t[2] - s[2] * t[1], s[2] * t[0] - s[0] * t[2], s[0] * t[1] - s[1] * t[0]};
  const double det = s[0][2] * n[0][0] + s[1][2] * n[1][0] + s[2][2] * n[2][0];
  const double inverse = 1.0 / det;
  const Pack4 g[3] = {inverse * n[0], inverse * n[1], inverse * n[2]};
  for (int axis = 0; axis < 3; ++axis) g[axis].store(cell.gradient[axis]);
  cell.size = max_lane(extent);

  const Pack4 signed_g[3] = {sign * g[0], sign * g[1], sign * g[2]};
  const double* v3 = at[3]->v;
  const Pack4 offset = (v3[0] * signed_g[0] + v3[1] * signed_g[1]) + v3[2] * signed_g[2];
  Pack4 c[3], sum;
  for (int j = 0; j < 3; ++j) {
    const double* v = at[j]->v;
    c[j] = ((v[0] - v3[0]) * signed_g[0] + (v[1] - v3[1]) * signed_g[1]) + (v[2] - v3[2]) * signed_g[2];
    c[j].store(cell.column[j]);
    sum += abs(c[j]);
  }
  offset.store(cell.offset);
  cell.norm = max_lane(sum);
  cell.resolution = max_lane(Pack4{at[0]->v[3], at[1]->v[3], at[2]->v[3], at[3]->v[3]});

  const double m01 = c[0][0] * c[1][1] - c[0][1] * c[1][0];
  const double m02 = c[0][0] * c[1][2] - c[0][2] * c[1][0];
  const double m12 = c[0][1] * c[1][2] - c[0][2] * c[1][1];
  cell.p = c[0][0] + c[1][1] + c[2][2];
  cell.q = -(m01 + (c[0][0] * c[2][2] - c[0][2] * c[2][0]) + (c[1][1] * c[2][2] - c[1][2] * c[2][1]));
  cell.r = c[2][2] * m01 - c[2][1] * m02 + c[2][0] * m12;
  // A sum is finite only if every part of it is.
  return __builtin_isfinite(cell.norm + max_abs(offset)) != 0;
}

}  // namespace PALPATE_PACK
}  // namespace palpate
