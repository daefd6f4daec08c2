#include "common/field/grid/tet_mesh.h"
#include "common/trace/exact/exact_kernel.h"

namespace palpate {
namespace {

constexpr double kInfinity = __builtin_huge_val();
constexpr double kUlp = 0x1p-52;
constexpr double kTangent = ExactPiece::kTangent;
constexpr int kMaxAttempts = 12;

/// The first t > 0 at which each b + w t + a t^2 / 2 comes to zero, by a formula for both signs of w; where b
/// is 0, when it does so again. Negative, infinite or NaN where it does not.
Pack4 quadratic_exits(const Pack4& b, const Pack4& w, const Pack4& a) {
  const Pack4 root = sqrt(w * w - 2.0 * (a * b));
  const Mask4 inside = Pack4{} < b;
  return select(inside, 2.0 * b, -2.0 * w) / select(inside, root - w, a);
}

/// Where the coordinate of one face comes to zero near t: a step of Halley's method on its Taylor polynomial
/// of degree five.
double refined_exit(const AffineCell& cell, double b, double w, double a, double j, double t) {
  const double k = cell.p * j + (cell.q * a + cell.r * w);
  const double l = cell.p * k + (cell.q * j + cell.r * a);
  const double value =
      b + t * (w + t * (0.5 * a + t * ((1.0 / 6) * j + t * ((1.0 / 24) * k + t * (1.0 / 120) * l))));
  const double slope = w + t * (a + t * (0.5 * j + t * ((1.0 / 6) * k + t * (1.0 / 24) * l)));
  const double curvature = a + t * (j + t * (0.5 * k + t * (1.0 / 6) * l));
  const double inverse = 1.0 / slope;
  const double step = value * inverse;
  return t - step * (1.0 + 0.5 * step * curvature * inverse);
}

/// The small root d of b + w d + a d^2 / 2 + j d^3 / 6, to the fourth order in b.
double small_root(double b, double w, double a, double j) {
  const double inverse = 1.0 / w;
  const double x = -b * inverse, c2 = 0.5 * a * inverse, c3 = (1.0 / 6) * j * inverse;
  return x * (1.0 - x * (c2 - x * (2.0 * c2 * c2 - c3)));
}

/// Certificate that each coordinate stays positive between the ends of a piece: Bernstein coefficients of the
/// quintic that shares value, slope and curvature with it at both ends. If the inner ones exceed the
/// interpolation error, so does the coordinate; ends at zero are the faces of entry and exit. Coordinates
/// in `ignored` (lines that lie in a face) stay at zero. @return whether it holds.
bool stays_inside(const Course& begin, const Course& end, double time, double theta, double fastest,
                  const Mask4& ignored) {
  const Pack4 s0 = (time / 5.0) * begin.w, s1 = (time / 5.0) * end.w;
  const Pack4 c0 = (time * time / 20.0) * begin.a, c1 = (time * time / 20.0) * end.a;
  const Pack4 b1 = begin.b + s0, b2 = b1 + s0 + c0, b4 = end.b - s1, b3 = b4 - s1 + c1;
  const double theta2 = theta * theta;
  const double interpolation = theta2 * theta2 * theta * time * fastest * (1.0 / 46080.0) *
                               (1.0 + 3.2 * theta);  // the last factor bounds exp(theta) up to kMaxRate
  const Pack4 lowest = min(min(b1, b2), min(b3, b4));
  return bits((Pack4::all(interpolation) < lowest) | ignored) == 0b1111u;
}

}  // namespace

inline namespace PALPATE_PACK {

PieceOutcome advance_piece(const AffineCell& cell, const ExactMeshView& mesh, ExactPiece& piece) noexcept {
  const Pack4 zero;
  Course begin{.b = Pack4::load_halves(piece.b), .w = Pack4::load_halves(piece.w)};
  const Pack4 magnitude = abs(begin.w);
  const double fastest = max_lane(magnitude);
  if (!(fastest > 0.0)) return PieceOutcome::kStandstill;
  const Pack4 tangent = Pack4::all(kTangent * fastest);

  // Already on a face and on the way out: cross it without a piece. By the face of entry only the robust path
  // may send a line back.
  const Mask4 on_face = begin.b <= zero;
  if (const unsigned leaving = bits(on_face & (begin.w < -1.0 * tangent)); leaving != 0u) {
    const int face = __builtin_ctz(leaving);
    if (face == piece.entry) return PieceOutcome::kRobust;
    piece.face = face;
    return PieceOutcome::kCross;
  }

  // The exit of the parabolas, then of the Taylor polynomial.
  begin.a = apply(cell, begin.w);
  begin.j = apply(cell, begin.a);
  const double longest = kMaxRate / cell.norm;
  double h = longest;
  int face = -1;
  std::int32_t beyond = kNoCell;
  const Pack4 exits = quadratic_exits(begin.b, begin.w, begin.a);
  const Mask4 possible = (zero < exits) & ((zero < begin.b) | (tangent < begin.w));
  const Pack4 times = select(possible, exits, Pack4::all(kInfinity));
  const double first = min_lane(times);
  // A cell that takes many pieces at this rate is for the other path, whose steps do not depend on it.
  constexpr double kManyPieces = 16.0;
  if (first > kManyPieces * longest && first < kInfinity) return PieceOutcome::kRobust;
  if (first < h) {
    face = __builtin_ctz(bits(times == Pack4::all(first)));
    alignas(32) double a[4], j[4];
    begin.a.store(a);
    begin.j.store(j);
    h = first;
    // The cell beyond lies anywhere in memory: fetch it while this one is computed.
    beyond = mesh.neighbors[piece.cell][face];
    if (beyond != kNoCell) {
      __builtin_prefetch(&mesh.cells[beyond]);
      __builtin_prefetch(&mesh.neighbors[beyond]);
    }
    const double better = refined_exit(cell, piece.b[face], piece.w[face], a[face], j[face], h);
    if (better > 0.5 * h && better < 2.0 * h && better < longest) h = better;
  } else if (!(h < kInfinity)) {
    return PieceOutcome::kRobust;
  }

  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    const Flow at_h = flow(cell, begin, h, pair_count(h * cell.norm));
    const Pack4 speeds = sqrt(at_h.squared_speed);
    const Arc arc = arc_length(piece.speed, speeds, h);
    if (beyond != kNoCell) {
      for (int i = 0; i < 4; ++i) __builtin_prefetch(&mesh.vertices[mesh.cells[beyond][i]]);
    }
    Course end{.b = at_h.b, .w = at_h.w, .a = apply(cell, at_h.w), .j = zero};
    double time = h, length = arc.length;
    alignas(32) double b[4], w[4];
    if (face >= 0) {
      // From the predicted crossing to the true one, by the series about the end of the flow.
      alignas(32) double a[4], j[4];
      end.j = apply(cell, end.a);
      end.b.store(b);
      end.w.store(w);
      end.a.store(a);
      end.j.store(j);
      if (!(w[face] < 0.0)) {  // the curve turns back before the face, or has come in again
        h *= 0.5;
        face = -1;
        continue;
      }
      const double d = small_root(b[face], w[face], a[face], j[face]);
      constexpr double kNear = 0x1p-17;  // |d C|: its cube over 3! is rounding
      if (!(__builtin_fabs(d) * cell.norm <= kNear && __builtin_fabs(d) <= 0.5 * h)) {
        h += d;
        if (!(h > 0.0)) return PieceOutcome::kRobust;
        if (h > longest) {  // the face is beyond the reach of the series: a piece on the way to it
          h = longest;
          face = -1;
        }
        continue;
      }
      end.b += d * (end.w + (0.5 * d) * (end.a + (d * (1.0 / 3)) * end.j));
      end.w += d * (end.a + (0.5 * d) * end.j);
      end.a += d * end.j;
      // The series is short where the slope nearly vanishes: the point is to lie on the face.
      end.b.store(b);
      if (!(__builtin_fabs(b[face]) <= kFaceRounding)) {
        h += d;
        continue;
      }
      time += d;
      const Pack4 v = velocity(cell, end.w);
      length += 0.5 * d * (speeds[3] + __builtin_sqrt(dot3(v, v)));
    }
    end.b.store(b);
    end.w.store(w);

    // Another face may have been crossed shortly before: then that one is the exit.
    int earlier = -1;
    double deepest = -kUlp;
    if (bits(end.b < Pack4::all(-kUlp)) != 0u) {
      for (int i = 0; i < 4; ++i) {
        if (i != face && b[i] < deepest) {
          deepest = b[i];
          earlier = i;
        }
      }
    }
    if (earlier >= 0 && w[earlier] < 0.0) {
      face = earlier;
      const double back = time - deepest / w[earlier];
      h = back > 0.5 * time ? back : 0.5 * time;
      continue;
    }
    const double theta = time * cell.norm;
    // A line that lies in a face stays there.
    const Mask4 in_face = on_face & (magnitude <= tangent) & (time * abs(begin.a) <= tangent);
    if (earlier >= 0 || !arc.sound || !stays_inside(begin, end, time, theta, fastest, in_face)) {
      h = 0.5 * time;
      face = -1;
      continue;
    }

    max(end.b, zero).store(piece.b_end);
    end.w.store(piece.w_end);
    if (face >= 0) {
      piece.b_end[face] = 0.0;
    }
    piece.time = time;
    piece.arc = length;
    piece.theta = theta;
    for (int i = 0; i < 3; ++i) piece.power[i] = at_h.power[i];
    piece.face = face;
    return PieceOutcome::kPiece;
  }
  return PieceOutcome::kRobust;
}

}  // namespace PALPATE_PACK
}  // namespace palpate
