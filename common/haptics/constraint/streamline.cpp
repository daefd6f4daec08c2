#include "common/haptics/constraint/streamline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/haptics/frame_along.h"
#include "common/trace/line_time.h"

namespace palpate {
namespace {

constexpr double kUlp = std::numeric_limits<double>::epsilon();

/// Ends that are no property of the data: the line goes on there if it is begun anew.
bool can_go_on(End end) noexcept {
  return end == End::kMaxLength || end == End::kMaxSteps || end == End::kLoop || end == End::kMaxTime;
}

}  // namespace

StreamlineConstraint::StreamlineConstraint(std::shared_ptr<LiveLine> line, const Workspace& workspace)
    : line_(std::move(line)), workspace_(workspace) {
  const VectorField& field = line_->field();
  const double to_local = power_of_two(-field.frame().length_exponent);
  local_max_speed_ = field.max_speed() * power_of_two(-field.frame().speed_exponent);
  const Box& box = field.bounds();
  const Vec3 farthest = glm::max(glm::abs(box.lower), glm::abs(box.upper)) * to_local;
  resolution_ = 8.0 * kUlp * std::max({farthest.x, farthest.y, farthest.z, field.diagonal() * to_local});
  reset();
}

void StreamlineConstraint::apply(const ChainSettings& settings) noexcept {
  release_ = settings.streamline.release_distance / workspace_.local_scale();
  speed_force_ = settings.streamline.speed_force;
}

void StreamlineConstraint::reset() noexcept {
  line_->drop();
  piece_ = 0;
  arc_ = 0.0;
}

void StreamlineConstraint::update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept {
  const Vec3 x = workspace_.local_from_workspace(probe);
  if (line() == nullptr) {
    if (!catch_at(x, budget, link)) {
      link.proxy = probe;
      return;
    }
    link.jumped = true;
  } else {
    grow(x, budget, link);
  }
  link.state = HoldState::kHeld;
  search(x, budget, link);
  if (glm::distance(point(), x) > release_) {
    link.jumped = true;
    const bool caught = catch_at(x, budget, link);
    link.state = HoldState::kReleased;
    if (!caught) {
      link.proxy = probe;
      line_->drop();
      return;
    }
  }
  describe(x, link);
  if (glm::distance(point(), x) == 0.0)
    link.proxy = probe;  // not away from it by the rounding of a change of frame
}

/// Begins the line through `x` in place of the one that is followed. Where there is none, says why.
bool StreamlineConstraint::catch_at(const Vec3& x, const UpdateBudget& budget, LinkUpdate& link) noexcept {
  if (!line_->start(x)) {
    line_->drop();
    link.state = HoldState::kOutside;
    return false;
  }
  piece_ = 0;
  arc_ = 0.0;
  ++catches_;
  GrowingLine& line = *line_->current();
  for (const Side side : {Side::kDownstream, Side::kUpstream}) {
    for (int used = 0; used < budget.cells / 2;) {
      const int work = line.grow(side);
      if (work == 0) break;
      used += work;
      link.cells += work;
    }
  }
  if (line.first() == line.last() && line.end(Side::kDownstream) && line.end(Side::kUpstream)) {
    // The flow rests here, or its data ends: a line without extent holds nothing.
    const bool rests =
        line.end(Side::kDownstream) == End::kStagnation || line.end(Side::kUpstream) == End::kStagnation;
    link.state = rests ? HoldState::kFellBack : HoldState::kOutside;
    line_->drop();
    return false;
  }
  debt_ += std::max(0, link.cells - budget.cells);
  fit();
  return true;
}

/// How far beyond the proxy the line is wanted.
double StreamlineConstraint::look_ahead() const noexcept {
  constexpr double kReleases = 2.0;
  constexpr double kMaxPart = 0.25;  // of what may be grown on either side
  return std::min(kReleases * release_, kMaxPart * line_->limits().max_length);
}

/// What is grown of the line beyond the proxy; infinite where that side has ended.
double StreamlineConstraint::room(Side side) const noexcept {
  const GrowingLine& line = *this->line();
  if (line.end(side)) return HUGE_VAL;
  return side == Side::kDownstream ? line.node(line.last()).arc - arc_ : arc_ - line.node(line.first()).arc;
}

/// Grows the line: first where the probe pulls to, then where less is left, by no more than the budget.
void StreamlineConstraint::grow(const Vec3& x, const UpdateBudget& budget, LinkUpdate& link) noexcept {
  go_on();
  GrowingLine& line = *line_->current();
  const double wanted = look_ahead();
  const bool downstream = glm::dot(x - point(), tangent()) >= 0.0;
  const Side ahead = downstream ? Side::kDownstream : Side::kUpstream;
  const Side behind = downstream ? Side::kUpstream : Side::kDownstream;
  debt_ = std::max(0, debt_ - budget.cells);
  while (link.cells < budget.cells) {
    const double room_ahead = room(ahead), room_behind = room(behind);
    const Side side = room_ahead < wanted || room_ahead <= room_behind ? ahead : behind;
    // What is not wanted yet waits until dear pieces of steps before are paid for.
    if (debt_ > 0 && room(side) >= wanted) break;
    const int work = line.grow(side);
    if (work == 0) break;  // that side had no less room than the other: both have ended
    link.cells += work;
  }
  debt_ += std::max(0, link.cells - budget.cells);
  fit();
}

/// Where the line was ended for its length, or because it closes on itself, and the proxy comes near that
/// end: the same line is begun anew at the proxy.
void StreamlineConstraint::go_on() noexcept {
  const GrowingLine& line = *this->line();
  const auto runs_out = [&](Side side, double left) {
    const std::optional<End> end = line.end(side);
    return end && can_go_on(*end) && left < look_ahead();
  };
  if (line.first() == line.last()) return;
  if (!runs_out(Side::kDownstream, line.node(line.last()).arc - arc_) &&
      !runs_out(Side::kUpstream, arc_ - line.node(line.first()).arc)) {
    return;
  }
  if (line_->start(point(), arc_, time_at(line, piece_, arc_))) piece_ = 0;
}

/// Keeps piece_ within the line, of which it may be the last node when there is nothing downstream.
void StreamlineConstraint::fit() noexcept {
  const GrowingLine& line = *this->line();
  if (line.first() < line.last()) piece_ = std::clamp(piece_, line.first(), line.last() - 1);
}

Vec3 StreamlineConstraint::point() const noexcept {
  const GrowingLine& line = *this->line();
  if (line.first() == line.last()) return line.node(0).position;
  return line.piece(piece_).at(arc_ - line.node(piece_).arc);
}

/// Of unit length.
Vec3 StreamlineConstraint::tangent() const noexcept {
  const GrowingLine& line = *this->line();
  if (line.first() == line.last()) return line.node(0).tangent;
  const Vec3 slope = line.piece(piece_).tangent(arc_ - line.node(piece_).arc);
  const double length = glm::length(slope);
  return length > 0.0 ? slope / length : line.node(piece_).tangent;
}

/// Moves piece_ and arc_ to the local minimum of the distance from `x`, see (1).
void StreamlineConstraint::search(const Vec3& x, const UpdateBudget& budget, LinkUpdate& link) noexcept {
  const GrowingLine& line = *this->line();
  const int first = line.first(), last = line.last();
  if (first == last) return;  // a single node as yet
  const HermitePiece here = line.piece(piece_);
  const double s = arc_ - line.node(piece_).arc;
  const double f = glm::dot(here.at(s) - x, here.tangent(s));
  if (std::abs(f) <= resolution_) return;
  const bool downstream = f < 0.0;
  double from = s;
  for (;;) {
    // At a node the slope of the cubic is the tangent there.
    const LineNode& node = line.node(downstream ? piece_ + 1 : piece_);
    const double at_node = glm::dot(node.position - x, node.tangent);
    const double to = downstream ? node.arc - line.node(piece_).arc : 0.0;
    if (downstream ? at_node >= 0.0 : at_node <= 0.0) {
      settle_in(x, downstream ? from : to, downstream ? to : from, budget, link);
      return;
    }
    const int next = downstream ? piece_ + 1 : piece_ - 1;
    const bool at_end = downstream ? next >= last : next < first;
    if (at_end || ++link.iterations >= budget.iterations) {
      arc_ = node.arc;
      const std::optional<End> end = line.end(downstream ? Side::kDownstream : Side::kUpstream);
      // A border holds the proxy; a critical point, a line not yet grown and a spent budget are fall-backs.
      const bool border = at_end && end && *end != End::kStagnation;
      if (!border) link.state = HoldState::kFellBack;
      link.at_end = border;
      return;
    }
    piece_ = next;
    from = downstream ? 0.0 : line.piece(next).length;
  }
}

/// The root of (1) in piece_, between arcs `low` and `high` from its first node.
void StreamlineConstraint::settle_in(const Vec3& x, double low, double high, const UpdateBudget& budget,
                                     LinkUpdate& link) noexcept {
  const GrowingLine& line = *this->line();
  const HermitePiece piece = line.piece(piece_);
  const double origin = line.node(piece_).arc;
  double s = std::clamp(arc_ - origin, low, high);
  double width = high - low;
  for (;;) {
    const Vec3 away = piece.at(s) - x, tangent = piece.tangent(s);
    const double f = glm::dot(away, tangent);
    if (std::abs(f) <= 0.5 * resolution_) break;
    (f < 0.0 ? low : high) = s;
    if (!(high - low > kUlp * piece.length)) break;
    if (++link.iterations >= budget.iterations) {
      link.state = HoldState::kFellBack;
      break;
    }
    const double slope = glm::dot(tangent, tangent) + glm::dot(away, piece.bend(s));
    const double newton = s - f / slope;
    // Newton's step where it stays inside and the bracket keeps shrinking; else the middle.
    const bool shrinks = high - low <= 0.5 * width || slope > 0.5;
    s = slope > 0.0 && newton > low && newton < high && shrinks ? newton : 0.5 * (low + high);
    width = high - low;
  }
  arc_ = origin + s;
}

/// |dp/dx|, by (1); 0 where the end of the line keeps the proxy from following `x`.
double StreamlineConstraint::pace(const Vec3& x) const noexcept {
  const GrowingLine& line = *this->line();
  if (line.first() == line.last()) return 0.0;
  const HermitePiece piece = line.piece(piece_);
  const double s = arc_ - line.node(piece_).arc;
  const Vec3 away = piece.at(s) - x, tangent = piece.tangent(s);
  const double f = glm::dot(away, tangent);
  const bool past_last = arc_ >= line.node(line.last()).arc && f < -resolution_;
  const bool before_first = arc_ <= line.node(line.first()).arc && f > resolution_;
  if (past_last || before_first) return 0.0;
  constexpr double kLeastSlope = 0x1p-20;  // next to a centre of curvature, where the proxy is about to leap
  const double squared = glm::dot(tangent, tangent);
  return squared / std::max(squared + glm::dot(away, piece.bend(s)), kLeastSlope);
}

void StreamlineConstraint::describe(const Vec3& x, LinkUpdate& link) const noexcept {
  const GrowingLine& line = *this->line();
  link.proxy = workspace_.workspace_from_local(point());
  double speed = line.node(0).speed;
  if (line.first() < line.last()) {
    const LineNode &a = line.node(piece_), &b = line.node(piece_ + 1);
    speed = a.speed + ((arc_ - a.arc) / (b.arc - a.arc)) * (b.speed - a.speed);
    link.residual = line.gap(piece_) * workspace_.local_scale();
  }
  const Vec3 along = workspace_.turned(tangent());
  link.frame = frame_along(along);
  link.jacobian = glm::outerProduct(pace(x) * along, along);
  link.extra_force = (speed_force_ * (speed / local_max_speed_)) * along;
}

}  // namespace palpate
