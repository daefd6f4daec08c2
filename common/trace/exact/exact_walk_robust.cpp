// The robust path of the walk: cells whose exit the fast one cannot certify, solved by affine_modes.h.
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/index.h"
#include "common/trace/exact/exact_walk.h"

namespace palpate {
namespace {

// As kRoundingPerCell, of a sum whose terms count without their signs: AffineModes::rounding().
constexpr double kRoundingOfModes = 10.0;
// Cost of the robust path, in fast pieces.
constexpr int kCellWork = 24, kLongCellWork = 160, kTryWork = 4;

Pack4 to_pack(const AffineModes::Four& b) { return {b[0], b[1], b[2], b[3]}; }

}  // namespace

void ExactWalk::enter_robust() {
  AffineModes::Four b{};
  const double sum = (b_[0] + b_[1]) + (b_[2] + b_[3]);
  for (int i = 0; i < 4; ++i) b[as_size(i)] = b_[i] / sum;
  modes_.emplace(mesh_->vertices(), mesh_->mesh().cells()[as_size(cell_index_)], sign_, b);
  work_ += modes_->is_long() ? kLongCellWork : kCellWork;
  if (modes_->is_long()) ++long_cells_;
  modes_time_ = 0.0;
  longest_ = std::numeric_limits<double>::infinity();
}

ExactWalk::RobustFlow ExactWalk::robust_flow(double start, double h, double stop) const {
  RobustFlow flow;
  flow.b = to_pack(modes_->at(stop));
  flow.w = to_pack(modes_->rate_at(stop));
  Pack4 squared;
  for (int m = 0; m < 4; ++m) {
    const Pack4 w = m == 3 ? flow.w : to_pack(modes_->rate_at(start + kArcNodes[m] * h));
    const Pack4 v = velocity(cell_, w);
    flow.velocity[as_size(m)] = v;
    squared.set(m, dot3(v, v));
  }
  flow.speed = sqrt(squared);
  return flow;
}

/// A time has no more digits than a double, so a fast line is on its face only within them: by the flow itself, which moves
/// the point along its curve. What is left is moved straight: where the line grazes the face, the point would
/// go a long way back on its curve for a last digit of its coordinate, against its time.
void ExactWalk::move_onto_face(RobustFlow& flow, int face, double stop) const {
  for (int n = 0; n < 2; ++n) {
    const Pack4 a = apply(cell_, flow.w), j = apply(cell_, a);
    const double d = -flow.b[face] / flow.w[face];
    constexpr double kNear = 0x1p-8;  // of the time in which the flow changes
    constexpr double kOfTime = 16.0 * kUlp;
    if (!(std::abs(d) * cell_.norm <= kNear && std::abs(d) <= kOfTime * stop)) break;
    flow.b += d * (flow.w + (0.5 * d) * (a + (d * (1.0 / 3)) * j));
    flow.w += d * (a + (0.5 * d) * j);
  }
}

std::optional<End> ExactWalk::robust_piece() {
  ++robust_pieces_;
  // The modes knew no further.
  if (modes_->exit().face < 0 && !modes_->rest() && !(modes_time_ < modes_->exit().time)) enter_robust();
  AffineModes& modes = *modes_;
  if (modes.exit().face >= 0 && !(modes.exit().time > modes_time_)) return cross_standing(modes.exit().face);
  // At rest, as far as the values at the vertices tell.
  if (modes.rest() && !(modes_time_ < modes.exit().time)) return End::kStagnation;
  const std::optional<Vec3> rest =
      modes.rest() ? std::optional(position(cell_, to_pack(*modes.rest())).xyz()) : std::nullopt;
  const Vec3 x0 = end_.position;
  // Rest within reach: the line is drawn to the distance asked for and ends.
  if (rest && glm::distance(*rest, x0) <= rest_distance_) return End::kStagnation;

  constexpr int kMaxTries = 100;
  constexpr double kMaxTurn = 0.9;   // cosine of 26 degrees
  constexpr double kMinChord = 0.8;  // of the arc: turns between the nodes of the rule show here
  constexpr double kShorter = 1.0 / 8, kLonger = 4.0;
  double h = longest_;
  for (int attempt = 0; attempt < kMaxTries; ++attempt) {
    work_ += kTryWork;
    const AffineModes::Exit& exit = modes.exit();
    const bool leaves = exit.face >= 0;
    const double remaining = exit.time - modes_time_;
    const bool whole = h >= remaining;
    h = std::min(h, remaining);
    const double stop = whole ? exit.time : modes_time_ + h;
    RobustFlow flow = robust_flow(modes_time_, h, stop);
    if (modes.leave_earlier(modes_time_, stop)) continue;
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
    const Arc arc = arc_length(end_.speed, flow.speed, h);
    const bool last = whole && leaves;
    if (last) move_onto_face(flow, exit.face, stop);
    const double chord = glm::distance(position(cell_, flow.b).xyz(), x0);
    const bool still = arc.length <= kUlp * cell_.size;
    const bool sound = turn >= kMaxTurn && arc.sound && chord >= kMinChord * arc.length;
    if (!sound && !still) {
      h *= kShorter;
      continue;
    }
    piece_.time = h;
    piece_start_ = modes_time_;
    robust_piece_ = true;
    // The error is carried by the modes themselves.
    error_.carry([&](const Vec3& e) {
      const Pack4 d = along(cell_, Pack4{e, 0.0});
      return velocity(cell_, to_pack(modes.carried({d[0], d[1], d[2], d[3]}, h))).xyz();
    });
    double moved = std::max(0.0, -std::min(std::min(flow.b[0], flow.b[1]), std::min(flow.b[2], flow.b[3])));
    if (last) moved = std::max(moved, std::abs(flow.b[exit.face]));
    // Farther than time has digits: the exit is not where the solution is.
    constexpr double kUncertain = 0x1p-20;
    if (!(moved <= kUncertain)) return End::kBadData;
    if (last) {
      flow.b.set(exit.face, 0.0);
      exit_face_ = exit.face;
    }
    modes_time_ = stop;
    longest_ = kLonger * h;
    const int entry = entry_;
    close_piece(flow.b, flow.w, h, arc.length,
                (kRoundingOfModes * modes.rounding(h, stop) + moved) * cell_.size);
    if (!last) entry_ = entry;
    if (rest && glm::distance(*rest, end_.position) <= rest_distance_) return End::kStagnation;
    return std::nullopt;
  }
  return End::kBadData;
}

}  // namespace palpate
