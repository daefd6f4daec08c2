#include "common/trace/growing_line.h"

#include <algorithm>
#include <cmath>

#include "common/base/index.h"

namespace palpate {

GrowingLine::GrowingLine(const VectorField& field, const WalkFactory& factory, const GrowthLimits& limits)
    : field_(field), limits_(limits) {
  for (const Side side : {Side::kDownstream, Side::kUpstream}) {
    OneSide& one = sides_[as_size(side)];
    one.walk = factory.make(side == Side::kDownstream ? TraceDirection::kForward : TraceDirection::kBackward);
    // Filled with zeros, so that the pages are there before the servo writes to them.
    one.nodes = std::make_unique<LineNode[]>(as_size(limits.capacity) + 1);
  }
}

LineNode GrowingLine::node_of(const LinePoint& point, const Vec3& tangent, Side side) const noexcept {
  const double sign = side == Side::kDownstream ? 1.0 : -1.0;
  return {.position = point.position,
          .tangent = sign * tangent,
          .arc = arc_ + sign * point.arc,
          .time = time_ + sign * point.time,
          .speed = point.speed,
          .error = point.error};
}

bool GrowingLine::start(const Vec3& seed, double arc, double time) noexcept {
  arc_ = arc;
  time_ = time;
  for (OneSide& one : sides_) {
    one.count.store(0, std::memory_order_relaxed);
    one.end.store(-1, std::memory_order_relaxed);
    one.hint = {};
  }
  bool inside = true;
  for (const Side side : {Side::kDownstream, Side::kUpstream}) {
    OneSide& one = sides_[as_size(side)];
    inside = inside && one.walk->start(seed);
    if (!inside) break;
    const LinePoint& begin = one.walk->end();
    inside = std::isfinite(begin.speed);
    one.nodes[0] = node_of(begin, one.walk->direction(), side);
    one.loop.start(begin, one.walk->direction());
  }
  if (!inside) {
    for (OneSide& one : sides_)
      one.end.store(static_cast<std::int8_t>(End::kBadData), std::memory_order_relaxed);
  }
  return inside;
}

int GrowingLine::grow(Side side) noexcept {
  OneSide& one = sides_[as_size(side)];
  if (one.end.load(std::memory_order_relaxed) >= 0) return 0;
  LineWalk& walk = *one.walk;
  std::optional<End> ended = walk.advance();
  const int work = walk.work();
  if (walk.has_piece() && walk.end().arc > walk.begin().arc) {
    const auto closing =
        ended ? std::nullopt : one.loop.closes(walk, walk.begin(), walk.end(), walk.direction());
    add_piece(one, side, closing ? closing->theta : 1.0);
    if (closing) ended = closing->why;
    if (!ended && walk.end().arc >= limits_.max_length) ended = End::kMaxLength;
    const int count = one.count.load(std::memory_order_relaxed);
    if (!ended && count + kMaxParts > limits_.capacity) ended = End::kMaxSteps;
  }
  if (ended) one.end.store(static_cast<std::int8_t>(*ended), std::memory_order_release);
  return work;
}

/// The direction of the flow at a point, from the field; `otherwise` where a point on the border is outside
/// by rounding.
Vec3 GrowingLine::tangent_at(const LinePoint& point, const Vec3& otherwise, CellHint& hint) const noexcept {
  const LocalFrame& frame = field_.frame();
  const VectorSample sample = field_.sample(frame.data_from_local(point.position), hint);
  if (sample.status != SampleStatus::kOk) return otherwise;
  const Vec3 v = sample.value * power_of_two(-frame.speed_exponent);
  const Vec3 turned = frame.rotated ? v * frame.rotation : v;
  const double speed = glm::length(turned);
  return speed > 0.0 ? turned / speed : otherwise;
}

/// Adds nodes for the last piece of the walk up to `cut`: its end, and as many inside as its bend asks for.
void GrowingLine::add_piece(OneSide& to, Side side, double cut) noexcept {
  const LineWalk& walk = *to.walk;
  const double sign = side == Side::kDownstream ? 1.0 : -1.0;
  int count = to.count.load(std::memory_order_relaxed);
  const auto gap_between = [&](const LineNode& a, const LineNode& b, double theta) {
    const double length = sign * (b.arc - a.arc);
    if (!(length > 0.0)) return 0.0;
    const HermitePiece cubic{a.position, sign * a.tangent, b.position, sign * b.tangent, length};
    const LinePoint middle = walk.at(theta);
    const double s = std::clamp(arc_ + sign * middle.arc, std::min(a.arc, b.arc), std::max(a.arc, b.arc));
    return glm::distance(cubic.at(sign * (s - a.arc)), middle.position);
  };

  const LineNode before = to.nodes[as_size(count)];
  const auto inner_node = [&](double theta, const Vec3& otherwise) {
    const LinePoint inner = walk.at(theta);
    return node_of(inner, sign * tangent_at(inner, otherwise, to.hint), side);
  };
  LineNode whole = cut < 1.0 ? inner_node(cut, before.tangent) : node_of(walk.end(), walk.direction(), side);
  whole.gap = gap_between(before, whole, 0.5 * cut);
  // The gap falls with the fourth power of the length.
  int parts = 1;
  if (whole.gap > limits_.max_gap) {
    constexpr double kSafety = 1.2;
    parts = static_cast<int>(
        std::min(std::ceil(kSafety * std::sqrt(std::sqrt(whole.gap / limits_.max_gap))), 1.0 * kMaxParts));
  }
  LineNode last = before;
  for (int i = 1; i <= parts; ++i) {
    LineNode next = whole;
    if (i < parts) next = inner_node(cut * i / parts, last.tangent);
    if (!(sign * (next.arc - last.arc) > 0.0)) continue;  // shorter than rounding
    if (parts > 1) next.gap = gap_between(last, next, cut * (i - 0.5) / parts);
    to.nodes[as_size(++count)] = next;
    last = next;
  }
  to.count.store(count, std::memory_order_release);
}

}  // namespace palpate
