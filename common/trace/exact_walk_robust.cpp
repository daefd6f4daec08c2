// The robust path of the walk: cells whose exit the fast one cannot certify, solved by affine_modes.h.
#include <algorithm>
#include <cmath>

#include "common/trace/exact_walk.h"

namespace palpate {
namespace {

// Cost of the robust path, in fast pieces.
constexpr int kRobustCellWork = 160, kRobustPieceWork = 16;

Pack4 to_pack(const AffineModes::Four& b) {
  return {static_cast<double>(b[0]), static_cast<double>(b[1]), static_cast<double>(b[2]),
          static_cast<double>(b[3])};
}

}  // namespace

void ExactWalk::enter_robust() {
  work_ += kRobustCellWork;
  AffineModes::Four b{};
  AffineModes::Real sum = 0.0L;
  for (int i = 0; i < 4; ++i) sum += b[static_cast<std::size_t>(i)] = b_[i];
  for (AffineModes::Real& value : b) value /= sum;
  modes_.emplace(mesh_->vertices(), mesh_->mesh().cells()[static_cast<std::size_t>(cell_index_)], sign_, b,
                 ignored_face_);
  mode_time_ = 0.0L;
  mode_step_ = 0.25L / modes_->rate();
}

ExactWalk::RobustFlow ExactWalk::robust_flow(AffineModes::Real start, AffineModes::Real h,
                                             AffineModes::Real stop) const {
  RobustFlow flow;
  flow.b = to_pack(modes_->at(stop));
  flow.w = to_pack(modes_->rate_at(stop));
  Pack4 squared;
  for (int m = 0; m < 4; ++m) {
    const Pack4 w = m == 3 ? flow.w : to_pack(modes_->rate_at(start + kArcNodes[m] * h));
    const Pack4 v = velocity(cell_, w);
    flow.velocity[static_cast<std::size_t>(m)] = v;
    squared.set(m, dot3(v, v));
  }
  flow.speed = sqrt(squared);
  return flow;
}

std::optional<End> ExactWalk::robust_piece() {
  using Real = AffineModes::Real;
  ++robust_pieces_;
  work_ += kRobustPieceWork;
  const AffineModes::Exit exit = modes_->exit();
  const bool leaves = exit.face >= 0;
  if (leaves && !(exit.time > mode_time_)) {
    // Sent on at once. Where two cells send the line back and forth it slides along their common face: the
    // second time it stays, and leaves by another face.
    if (exit.face == entry_ && standing_ > 1) {
      ++standing_;
      ignored_face_ = entry_;
      modes_.reset();
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
  if (modes_->rest()) rest = position(cell_, to_pack(*modes_->rest())).xyz();
  if (rest && glm::distance(*rest, x0) <= rest_distance_) return End::kStagnation;

  constexpr int kMaxTries = 200;
  constexpr double kMaxTurn = 0.9;  // cosine of 26 degrees
  const Real remaining = leaves ? exit.time - mode_time_ : HUGE_VALL;
  Real h = std::min(2.0L * mode_step_, remaining);
  for (int attempt = 0; attempt < kMaxTries; ++attempt, h *= 0.5L) {
    const bool last = leaves && h >= remaining;
    const Real stop = last ? exit.time : mode_time_ + h;
    const RobustFlow flow = robust_flow(mode_time_, h, stop);
    Vec3 before = direction_;
    double turn = 1.0;
    for (int m = 0; m < 4; ++m) {
      const Vec3 v = flow.velocity[static_cast<std::size_t>(m)].xyz();
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
    piece_mode_start_ = mode_time_;
    piece_robust_ = true;
    // The error is carried by the modes themselves.
    const Vec3& e = error_.vector();
    AffineModes::Four d{};
    for (std::size_t i = 0; i < 3; ++i) {
      d[i] = glm::dot(barycentric_gradient(cell_, static_cast<int>(i)), e);
      d[3] -= d[i];
    }
    const Pack4 carried = to_pack(modes_->carried(d, h));
    error_.set(velocity(cell_, carried).xyz());
    Pack4 b = flow.b;
    if (last) {
      b.set(exit.face, 0.0);
      exit_face_ = exit.face;
    }
    mode_time_ = stop;
    mode_step_ = h;
    const int entry = entry_;
    close_piece(b, flow.w, static_cast<double>(h), arc.length, kRoundingPerCell * kUlp * cell_.size);
    if (!last) entry_ = entry;
    if (rest && glm::distance(*rest, end_.position) <= rest_distance_) return End::kStagnation;
    return std::nullopt;
  }
  return End::kStagnation;
}

}  // namespace palpate
