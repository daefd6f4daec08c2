/// The flow inside one linear tetrahedron, solved exactly.
///
/// With v_j the vectors at the vertices and g_i the gradients of the barycentric coordinates b_i,
///
///   b' = B b,   B_ij = g_i . v_j,   the columns of B sum to zero                                    (1)
///
/// so w = b' obeys w' = C w with C_ij = g_i . (v_j - v_3), j < 3. C has three columns that matter, and its
/// characteristic polynomial l^3 = p l^2 + q l + r brings every power back to the first three
/// (Cayley-Hamilton): with u = w(0), a = C u, j = C a,
///
///   w(h) = A_0 u + A_1 a + A_2 j,   b(h) = b(0) + B_0 u + B_1 a + B_2 j                               (2)
///   A_2 = S_0,  A_1 = h + q S_1 + r S_2,  A_0 = 1 + r S_1                                             (3)
///   B_2 = S_1,  B_1 = S_0 - p S_1,        B_0 = h + r S_2,     S_m = sum_k s_k h^(k+m) / (k+m)!         (4)
///   s_2 = 1,    s_(k+1) = p s_k + q s_(k-1) + r s_(k-2)                                               (5)
///
/// s_k is the complete homogeneous symmetric polynomial of degree k - 2 of the eigenvalues. So the series is
/// one of scalars, summed to rounding, and a further time costs three scalars (A_0, A_1, A_2) alone: speeds
/// at the nodes of the arc length come from the six scalar products of the three vectors. Nothing is located
/// again at a face: three coordinates are carried over to the neighbour under its own numbering. All in
/// frame L. This is the fast path, for |h C| <= kMaxRate; what it cannot certify goes to affine_modes.h.
#pragma once

#include <cstdint>

#include "common/math/pack4.h"
#include "common/math/vec.h"
#include "common/trace/exact/exact_series.h"

namespace palpate {

/// A barycentric coordinate down to minus this is zero but for rounding.
inline constexpr double kFaceRounding = 0x1p-47;

/// Position and vector of a mesh point in one cache line: a cell gathers four.
struct alignas(64) PackedVertex {
  double x[4];  ///< last lane 0
  double v[4];  ///< last lane: speeds below it are rounding of v
};

/// One tetrahedron with its rates: plain numbers, four lanes a row, the same for every kind of Pack4.
struct AffineCell {
  alignas(32) double column[3][4];    ///< of C
  alignas(32) double offset[4];       ///< B's column 3
  alignas(32) double edge[3][4];      ///< x_j - x_3; last lane 0
  alignas(32) double corner[4];       ///< x_3; last lane 0
  alignas(32) double gradient[3][4];  ///< component x, y or z of g_0 ... g_3
  double p, q, r;                     ///< of the characteristic polynomial of C
  double norm;                        ///< largest row sum of |C|
  double resolution;                  ///< speeds below it are rounding of the vectors at the vertices
  double size;  ///< no edge at vertex 3 is longer; at most sqrt(3) times the longest edge
};

inline namespace PALPATE_PACK {

/// @param sign 1, or -1 to trace backward.
/// @return false where a vertex's vector is not finite.
[[nodiscard]] bool load_cell(AffineCell& cell, const PackedVertex* vertices, const std::uint32_t* tet,
                             double sign) noexcept;

/// w = B b.
[[nodiscard]] inline Pack4 rate(const AffineCell& cell, const Pack4& b) noexcept {
  return Pack4::load(cell.offset) +
         (lanes<0, 0, 0, 0>(b) * Pack4::load(cell.column[0]) +
          lanes<1, 1, 1, 1>(b) * Pack4::load(cell.column[1])) +
         lanes<2, 2, 2, 2>(b) * Pack4::load(cell.column[2]);
}
/// C u.
[[nodiscard]] inline Pack4 apply(const AffineCell& cell, const Pack4& u) noexcept {
  return (lanes<0, 0, 0, 0>(u) * Pack4::load(cell.column[0]) +
          lanes<1, 1, 1, 1>(u) * Pack4::load(cell.column[1])) +
         lanes<2, 2, 2, 2>(u) * Pack4::load(cell.column[2]);
}
/// The vector that belongs to w: sum_j w_j x_j. Last lane 0.
[[nodiscard]] inline Pack4 velocity(const AffineCell& cell, const Pack4& w) noexcept {
  return (lanes<0, 0, 0, 0>(w) * Pack4::load(cell.edge[0]) +
          lanes<1, 1, 1, 1>(w) * Pack4::load(cell.edge[1])) +
         lanes<2, 2, 2, 2>(w) * Pack4::load(cell.edge[2]);
}
[[nodiscard]] inline Pack4 position(const AffineCell& cell, const Pack4& b) noexcept {
  return Pack4::load(cell.corner) + velocity(cell, b);
}
/// The rates of the barycentric coordinates along a vector.
[[nodiscard]] inline Pack4 along(const AffineCell& cell, const Pack4& d) noexcept {
  return (lanes<0, 0, 0, 0>(d) * Pack4::load(cell.gradient[0]) +
          lanes<1, 1, 1, 1>(d) * Pack4::load(cell.gradient[1])) +
         lanes<2, 2, 2, 2>(d) * Pack4::load(cell.gradient[2]);
}
[[nodiscard]] inline Vec3 barycentric_gradient(const AffineCell& cell, int i) noexcept {
  return {cell.gradient[0][i], cell.gradient[1][i], cell.gradient[2][i]};
}

/// A beginning, with its first derivatives.
struct Course {
  Pack4 b, w, a, j;
};

struct Flow {
  Pack4 b;
  Pack4 w;
  Pack4 squared_speed;  ///< at kArcNodes
  double power[3];      ///< exp(h C) = power[0] + power[1] C + power[2] C^2
};

/// Evaluates (2). `pairs`: at least pair_count(|h| cell.norm). @pre h > 0, h cell.norm <= kMaxRate.
[[nodiscard]] inline Flow flow(const AffineCell& cell, const Course& course, double h, int pairs) noexcept {
  const double p = h * cell.p, q = (h * h) * cell.q, r = (h * h) * (h * cell.r);
  const SeriesSums s = sum_series(p, q, r, pairs);
  // (3) at the nodes, (4) at the end; all by powers of h C.
  const Pack4 a0 = Pack4::all(1.0) + r * s.s1;
  const Pack4 a1 = Pack4::load(kArcNodes) + (q * s.s1 + r * s.s2);
  const Pack4& a2 = s.s0;
  const Pack4 u = course.w, a = h * course.a, j = (h * h) * course.j;
  Flow out;
  out.w = a0[3] * u + (a1[3] * a + a2[3] * j);
  out.b = course.b + h * ((1.0 + r * s.s2[3]) * u + ((s.s0[3] - p * s.s1[3]) * a + s.s1[3] * j));
  out.power[0] = a0[3];
  out.power[1] = h * a1[3];
  out.power[2] = (h * h) * a2[3];
  const Pack4 vu = velocity(cell, u), va = velocity(cell, a), vj = velocity(cell, j);
  out.squared_speed = a0 * (dot3(vu, vu) * a0 + ((2.0 * dot3(vu, va)) * a1 + (2.0 * dot3(vu, vj)) * a2)) +
                      (a1 * (dot3(va, va) * a1 + (2.0 * dot3(va, vj)) * a2) + dot3(vj, vj) * (a2 * a2));
  return out;
}

struct Arc {
  double length;
  bool sound;  ///< whether the rule has converged, to some 1e-12
};

/// Arc length of a piece of duration h by the five-point Lobatto rule from its speeds: `first` at the
/// beginning, `others` at kArcNodes.
[[nodiscard]] inline Arc arc_length(double first, const Pack4& others, double h) noexcept {
  constexpr double kEndWeight = 1.0 / 20, kOuterWeight = 49.0 / 180, kMiddleWeight = 16.0 / 45;
  const double ends = first + others[3];
  const double lobatto =
      kEndWeight * ends + kOuterWeight * (others[0] + others[2]) + kMiddleWeight * others[1];
  const double simpson = (ends + 4.0 * others[1]) * (1.0 / 6.0);
  // The error of Simpson's rule falls with the fourth power of the step, that of the longer rule with the
  // eighth. For sqrt(t^2 + d^2), what a speed is near its zeros, the latter is below 4 times the square of
  // the difference.
  constexpr double kConverged = 5e-7;
  return {h * lobatto, __builtin_fabs(lobatto - simpson) <= kConverged * lobatto};
}

}  // namespace PALPATE_PACK
}  // namespace palpate
