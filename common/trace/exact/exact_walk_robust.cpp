// The robust path of the walk: cells whose exit the fast one cannot certify, solved by affine_modes.h.
#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "common/base/index.h"
#include "common/trace/exact/exact_walk.h"

namespace palpate {
namespace {

// Cost of the robust path, in fast pieces.
template <class Real>
constexpr int kCellWork = std::is_same_v<Real, double> ? 24 : 160;
template <class Real>
constexpr int kPieceWork = std::is_same_v<Real, double> ? 4 : 16;

template <class Real>
Pack4 to_pack(const std::array<Real, 4>& b) {
  return {static_cast<double>(b[0]), static_cast<double>(b[1]), static_cast<double>(b[2]),
          static_cast<double>(b[3])};
}

}  // namespace

/// Doubles first: they answer ten times sooner, and for all but the stiffest cells.
void ExactWalk::enter_robust() {
  solve(robust_);
  if (robust_.modes->certain()) return;
  robust_.modes.reset();
  solve(long_);
  ++long_cells_;
}

template <class Real>
void ExactWalk::solve(Robust<Real>& robust) {
  work_ += kCellWork<Real>;
  std::array<Real, 4> b{};
  Real sum = 0;
  for (int i = 0; i < 4; ++i) sum += b[as_size(i)] = b_[i];
  for (Real& value : b) value /= sum;
  robust.modes.emplace(mesh_->vertices(), mesh_->mesh().cells()[as_size(cell_index_)], sign_, b,
                       ignored_face_);
  robust.time = 0;
  robust.step = Real(0.25) / robust.modes->rate();
}

template <class Real>
ExactWalk::RobustFlow ExactWalk::robust_flow(const AffineModes<Real>& modes, Real start, Real h,
                                             Real stop) const {
  RobustFlow flow;
  flow.b = to_pack(modes.at(stop));
  flow.w = to_pack(modes.rate_at(stop));
  Pack4 squared;
  for (int m = 0; m < 4; ++m) {
    const Pack4 w = m == 3 ? flow.w : to_pack(modes.rate_at(start + kArcNodes[m] * h));
    const Pack4 v = velocity(cell_, w);
    flow.velocity[as_size(m)] = v;
    squared.set(m, dot3(v, v));
  }
  flow.speed = sqrt(squared);
  return flow;
}

ExactWalk::RobustFlow ExactWalk::robust_flow_to(double h) const {
  if (piece_path_ == Path::kRobust) {
    return robust_flow(*robust_.modes, robust_.piece_start, h, robust_.piece_start + h);
  }
  return robust_flow<long double>(*long_.modes, long_.piece_start, h, long_.piece_start + h);
}

template <class Real>
std::optional<End> ExactWalk::robust_piece(Robust<Real>& robust) {
  ++robust_pieces_;
  work_ += kPieceWork<Real>;
  const AffineModes<Real>& modes = *robust.modes;
  const typename AffineModes<Real>::Exit exit = modes.exit();
  const bool leaves = exit.face >= 0;
  if (leaves && !(exit.time > robust.time)) {
    // Sent on at once. Where two cells send the line back and forth it slides along their common face: the
    // second time it stays, and leaves by another face.
    if (exit.face == entry_ && standing_ > 1) {
      ++standing_;
      ignored_face_ = entry_;
      leave_robust();
      enter_robust();
      return std::nullopt;
    }
    const int face = exit.face;
    if (const std::optional<End> ended = cross_standing(face)) return ended;
    return std::nullopt;
  }

  // Rest within reach: the line is drawn to the distance asked for and ends.
  const Vec3 x0 = end_.position;
  std::optional<Vec3> rest;
  if (modes.rest()) rest = position(cell_, to_pack(*modes.rest())).xyz();
  if (rest && glm::distance(*rest, x0) <= rest_distance_) return End::kStagnation;

  constexpr int kMaxTries = 200;
  constexpr double kMaxTurn = 0.9;  // cosine of 26 degrees
  const Real remaining = leaves ? exit.time - robust.time : std::numeric_limits<Real>::infinity();
  Real h = std::min(2 * robust.step, remaining);
  for (int attempt = 0; attempt < kMaxTries; ++attempt, h *= Real(0.5)) {
    const bool last = leaves && h >= remaining;
    const Real stop = last ? exit.time : robust.time + h;
    const RobustFlow flow = robust_flow(modes, robust.time, h, stop);
    Vec3 before = direction_;
    double turn = 1.0;
    for (int m = 0; m < 4; ++m) {
      const Vec3 v = flow.velocity[as_size(m)].xyz();
      const double speed = flow.speed[m];
      if (speed > 0.0) {
        turn = std::min(turn, glm::dot(before, v) / speed);
        before = v / speed;
      }
    }
    const Arc arc = arc_length(end_.speed, flow.speed, static_cast<double>(h));
    const bool still = max_abs(flow.w) <= 0.0 || arc.length <= kUlp * cell_.size;
    if ((turn < kMaxTurn || !arc.sound) && !still && attempt + 1 < kMaxTries) continue;
    // A step that no longer moves the line, away from any exit: it has come to rest to rounding.
    if (arc.length <= kUlp * kUlp * cell_.size && !last) return End::kStagnation;

    piece_.time = static_cast<double>(h);
    robust.piece_start = robust.time;
    piece_path_ = std::is_same_v<Real, double> ? Path::kRobust : Path::kLong;
    // The error is carried by the modes themselves.
    const Vec3& e = error_.vector();
    std::array<Real, 4> d{};
    for (std::size_t i = 0; i < 3; ++i) {
      d[i] = glm::dot(barycentric_gradient(cell_, static_cast<int>(i)), e);
      d[3] -= d[i];
    }
    const Pack4 carried = to_pack(modes.carried(d, h));
    error_.set(velocity(cell_, carried).xyz());
    Pack4 b = flow.b;
    if (last) {
      b.set(exit.face, 0.0);
      exit_face_ = exit.face;
    }
    robust.time = stop;
    robust.step = h;
    const int entry = entry_;
    // Rounding of a double for each unit of rate times time, see affine_modes.h.
    const double roundings = std::is_same_v<Real, double> ? 1.0 + static_cast<double>(modes.rate() * h) : 1.0;
    close_piece(b, flow.w, static_cast<double>(h), arc.length,
                kRoundingPerCell * kUlp * cell_.size * roundings);
    if (!last) entry_ = entry;
    if (rest && glm::distance(*rest, end_.position) <= rest_distance_) return End::kStagnation;
    return std::nullopt;
  }
  return End::kStagnation;
}

template std::optional<End> ExactWalk::robust_piece(Robust<double>& robust);
template std::optional<End> ExactWalk::robust_piece(Robust<long double>& robust);

}  // namespace palpate
