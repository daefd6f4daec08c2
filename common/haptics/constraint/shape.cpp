#include "common/haptics/constraint/shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/check.h"
#include "common/haptics/fade.h"
#include "common/haptics/frame_along.h"

namespace palpate {

void ShapeConstraint::apply(const ChainSettings& settings) noexcept {
  settings_ = settings.shape;
  carry_ = settings.carry;
  stiffness_ = settings.stiffness;
}

void ShapeConstraint::reset() noexcept {
  held_ = false;
  carried_.reset();
  contact_ = {};
  passed_ = 0.0;
}

void ShapeConstraint::update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept {
  Foot foot;
  link.proxy = probe;
  if (held_) {
    follow_foot(probe, budget.iterations, foot);
  } else if (!catch_foot(probe, settings_.snap_distance, budget.iterations, foot)) {
    link.iterations = foot.iterations;
    passed_ = 0.0;
    return;
  }
  link.iterations = foot.iterations;
  const double stretch = glm::distance(probe, foot.point);
  const bool holds = stretch <= (held_ ? settings_.release_distance : settings_.snap_distance);
  link.jumped = holds != held_;
  if (!holds) {
    if (held_) link.state = HoldState::kReleased;
    reset();
    return;
  }
  held_ = true;
  link.proxy = foot.point;
  link.frame = foot.axes;
  link.kappa = foot.kappa;
  link.jacobian = foot.jacobian;
  link.state = foot.certain ? HoldState::kHeld : HoldState::kFellBack;
  contact_ = {.touches = true, .depth = stretch, .normal = foot.axes[0]};
  if (const std::optional<CurvePlace> hand = place()) {
    link.at_end = !hand->closed && (hand->arc <= 0.0 || hand->arc >= hand->length);
    if (carry_.speed > 0.0) {
      carry(probe, *hand, link);
    } else {
      carried_.reset();
    }
  }
  passed_ = 0.0;
}

/// (c) of the header.
void ShapeConstraint::carry(const Vec3& probe, const CurvePlace& hand, LinkUpdate& link) noexcept {
  constexpr double kRest = 0.5;  // of the release distance is left for what stretches across
  const double held = stiffness_ > 0.0 ? carry_.force / stiffness_ : 0.0;
  const double most = std::min(held, kRest * settings_.release_distance);
  double ahead = carried_.value_or(hand.arc) + carry_.speed * passed_ - hand.arc;
  if (hand.closed) ahead = std::remainder(ahead, hand.length);
  double arc = hand.arc + std::clamp(ahead, -most, most);
  if (hand.closed) {
    arc -= hand.length * std::floor(arc / hand.length);
  } else {
    arc = std::clamp(arc, 0.0, hand.length);
    link.at_end = arc >= hand.length;
  }
  carried_ = arc;
  Foot goal;
  stand_at_arc(arc, goal);
  const Vec3& along = goal.axes[0];
  link.proxy = goal.point;
  link.frame = goal.axes;
  link.kappa = {0.0, 1.0, 1.0};
  link.extra_force =
      std::clamp(stiffness_ * glm::dot(goal.point - probe, along), -carry_.force, carry_.force) * along;
  link.jacobian = Mat3{0.0};
}

namespace {

constexpr double kCore = 0.25;          // part of the radius within which the stiffness along it fades
constexpr double kLeastPart = 0x1p-20;  // of the radius: J stays finite on the axis, or at the centre
constexpr int kVisitsAnIteration = 8;   // boxes of a tree that cost as much as a segment

}  // namespace

CircleConstraint::CircleConstraint(const Vec3& center, const Vec3& normal, double radius)
    : center_(center),
      normal_(glm::normalize(normal)),
      radius_(radius),
      start_(frame_along(normal_)[1]),
      outward_(start_) {}

bool CircleConstraint::catch_foot(const Vec3& probe, double /*reach*/, int iterations, Foot& foot) noexcept {
  follow_foot(probe, iterations, foot);
  return true;
}

void CircleConstraint::follow_foot(const Vec3& probe, int /*iterations*/, Foot& foot) noexcept {
  const Vec3 away = probe - center_;
  const Vec3 flat = away - glm::dot(away, normal_) * normal_;
  const double distance = glm::length(flat);
  if (distance > kLeastPart * radius_) outward_ = flat / distance;
  const Vec3 along = glm::cross(normal_, outward_);
  foot.point = center_ + radius_ * outward_;
  foot.axes = {along, outward_, normal_};
  foot.kappa.y = fade(distance / (kCore * radius_));
  foot.jacobian = (radius_ / std::max(distance, kLeastPart * radius_)) * glm::outerProduct(along, along);
}

std::optional<CurvePlace> CircleConstraint::place() const noexcept {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  double angle = std::atan2(glm::dot(glm::cross(normal_, start_), outward_), glm::dot(start_, outward_));
  if (angle < 0.0) angle += kTurn;
  return CurvePlace{.arc = radius_ * angle, .length = radius_ * kTurn, .closed = true};
}

void CircleConstraint::stand_at_arc(double arc, Foot& foot) const noexcept {
  const double angle = arc / radius_;
  const Vec3 outward = std::cos(angle) * start_ + std::sin(angle) * glm::cross(normal_, start_);
  foot.point = center_ + radius_ * outward;
  foot.axes = {glm::cross(normal_, outward), outward, normal_};
}

bool SphereConstraint::catch_foot(const Vec3& probe, double /*reach*/, int iterations, Foot& foot) noexcept {
  follow_foot(probe, iterations, foot);
  return true;
}

void SphereConstraint::follow_foot(const Vec3& probe, int /*iterations*/, Foot& foot) noexcept {
  const Vec3 away = probe - center_;
  const double distance = glm::length(away);
  if (distance > kLeastPart * radius_) normal_ = away / distance;
  foot.point = center_ + radius_ * normal_;
  foot.axes = frame_along(normal_);
  foot.kappa = Vec3{fade(distance / (kCore * radius_))};
  const double pace = radius_ / std::max(distance, kLeastPart * radius_);
  foot.jacobian = pace * (Mat3{1.0} - glm::outerProduct(normal_, normal_));
}

PlaneConstraint::PlaneConstraint(const Vec3& point, const Vec3& normal)
    : point_(point), axes_(frame_along(glm::normalize(normal))) {}

bool PlaneConstraint::catch_foot(const Vec3& probe, double /*reach*/, int iterations, Foot& foot) noexcept {
  follow_foot(probe, iterations, foot);
  return true;
}

void PlaneConstraint::follow_foot(const Vec3& probe, int /*iterations*/, Foot& foot) noexcept {
  const Vec3& n = axes_[0];
  foot.point = probe - glm::dot(probe - point_, n) * n;
  foot.axes = axes_;
  foot.jacobian = Mat3{1.0} - glm::outerProduct(n, n);
}

PolylineConstraint::PolylineConstraint(std::span<const std::vector<Vec3>> lines, Ends ends) {
  std::vector<Box> boxes;
  for (const std::vector<Vec3>& vertices : lines) {
    const auto first = static_cast<Index>(segments_.size());
    double arc = 0.0;
    for (std::size_t i = 1; i < vertices.size(); ++i) {
      const Vec3 &a = vertices[i - 1], &b = vertices[i];
      if (a == b) continue;
      segments_.push_back({a, b, arc, static_cast<Index>(lines_.size())});
      arc += glm::distance(a, b);
      Box& box = boxes.emplace_back();
      box.include(a);
      box.include(b);
    }
    const auto end = static_cast<Index>(segments_.size());
    if (end == first) continue;
    lines_.push_back({first, end, arc, ends == Ends::kJoined && segments_[first].a == segments_[end - 1].b});
  }
  PALPATE_CHECK(!segments_.empty());
  tree_ = BoxTree(boxes);
}

/// t of the foot of `probe` on the line of `segment`; beyond [0, 1] where it lies past an end.
double PolylineConstraint::part_of(Index segment, const Vec3& probe) const noexcept {
  const Vec3 &a = segments_[segment].a, along = segments_[segment].b - a;
  return glm::dot(probe - a, along) / glm::dot(along, along);
}

Vec3 PolylineConstraint::point(Index segment, double t) const noexcept {
  const Vec3 &a = segments_[segment].a, &b = segments_[segment].b;
  if (t <= 0.0) return a;
  return t < 1.0 ? a + t * (b - a) : b;
}

/// From `probe` to `segment`.
double PolylineConstraint::distance(Index segment, const Vec3& probe) const noexcept {
  return glm::distance(probe, point(segment, part_of(segment, probe)));
}

PolylineConstraint::Index PolylineConstraint::neighbour(Index segment, bool after) const noexcept {
  const Line& line = lines_[segments_[segment].line];
  if (after) {
    if (segment + 1 < line.end) return segment + 1;
    return line.joined && line.first != segment ? line.first : kEnd;
  }
  if (segment > line.first) return segment - 1;
  return line.joined && line.end - 1 != segment ? line.end - 1 : kEnd;
}

/// Fills `foot` with place `t` of segment_.
void PolylineConstraint::stand_at(double t, Foot& foot) noexcept {
  const Segment& on = segments_[segment_];
  part_ = std::clamp(t, 0.0, 1.0);
  foot.point = point(segment_, t);
  foot.axes = frame_along(glm::normalize(on.b - on.a));
  if (t > 0.0 && t < 1.0) foot.jacobian = glm::outerProduct(foot.axes[0], foot.axes[0]);
}

bool PolylineConstraint::catch_foot(const Vec3& probe, double reach, int iterations, Foot& foot) noexcept {
  const BoxTree::Found found = tree_.nearest(probe, reach, kVisitsAnIteration * iterations,
                                             [&](std::uint32_t segment) { return distance(segment, probe); });
  foot.iterations = std::min(iterations, (found.visits + kVisitsAnIteration - 1) / kVisitsAnIteration);
  if (found.thing == BoxTree::kNone) return false;
  foot.certain = found.complete;
  segment_ = found.thing;
  stand_at(part_of(segment_, probe), foot);
  return true;
}

void PolylineConstraint::follow_foot(const Vec3& probe, int iterations, Foot& foot) noexcept {
  double nearest = distance(segment_, probe);
  for (;;) {
    Index best = segment_;
    for (const bool after : {true, false}) {
      const Index other = neighbour(segment_, after);
      if (other == kEnd) continue;
      const double there = distance(other, probe);
      if (!(there < nearest)) continue;
      nearest = there;
      best = other;
    }
    if (best == segment_) break;
    if (++foot.iterations >= iterations) {
      foot.certain = false;
      break;
    }
    segment_ = best;
  }
  stand_at(part_of(segment_, probe), foot);
}

std::optional<CurvePlace> PolylineConstraint::place() const noexcept {
  const Segment& on = segments_[segment_];
  const Line& line = lines_[on.line];
  const bool last = segment_ + 1 == line.end && part_ >= 1.0;
  const double arc = last ? line.length : on.arc + part_ * glm::distance(on.a, on.b);
  return CurvePlace{.arc = arc, .length = line.length, .closed = line.joined};
}

void PolylineConstraint::stand_at_arc(double arc, Foot& foot) const noexcept {
  const Line& line = lines_[segments_[segment_].line];
  Index low = line.first, high = line.end;  // the last segment that begins no later
  while (high - low > 1) {
    const Index middle = low + (high - low) / 2;
    (segments_[middle].arc <= arc ? low : high) = middle;
  }
  const Segment& on = segments_[low];
  const double length = glm::distance(on.a, on.b);
  foot.point = point(low, (arc - on.arc) / length);
  foot.axes = frame_along((on.b - on.a) / length);
}

}  // namespace palpate
