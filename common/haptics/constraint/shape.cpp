#include "common/haptics/constraint/shape.h"

#include <algorithm>
#include <utility>

#include "common/base/check.h"
#include "common/haptics/fade.h"
#include "common/haptics/frame_along.h"

namespace palpate {

void ShapeConstraint::reset() noexcept {
  held_ = false;
  forget();
}

void ShapeConstraint::update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept {
  Foot foot;
  link.proxy = probe;
  if (held_) {
    follow_foot(probe, budget.iterations, foot);
  } else if (!catch_foot(probe, budget.iterations, foot)) {
    link.iterations = foot.iterations;
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
}

namespace {

constexpr double kCore = 0.25;          // part of the radius within which the stiffness along it fades
constexpr double kLeastPart = 0x1p-20;  // of the radius: J stays finite on the axis, or at the centre

}  // namespace

CircleConstraint::CircleConstraint(const Vec3& center, const Vec3& normal, double radius)
    : center_(center), normal_(glm::normalize(normal)), radius_(radius), outward_(frame_along(normal_)[1]) {}

bool CircleConstraint::catch_foot(const Vec3& probe, int iterations, Foot& foot) noexcept {
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

bool SphereConstraint::catch_foot(const Vec3& probe, int iterations, Foot& foot) noexcept {
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

PolylineConstraint::PolylineConstraint(std::vector<Vec3> vertices) : vertices_(std::move(vertices)) {
  vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  PALPATE_CHECK(vertices_.size() >= 2);
}

/// t of the foot of `probe` on the line of `segment`; beyond [0, 1] where it lies past an end.
double PolylineConstraint::place(Index segment, const Vec3& probe) const noexcept {
  const Vec3 &a = vertices_[segment], along = vertices_[segment + 1] - a;
  return glm::dot(probe - a, along) / glm::dot(along, along);
}

Vec3 PolylineConstraint::point(Index segment, double t) const noexcept {
  const Vec3 &a = vertices_[segment], &b = vertices_[segment + 1];
  if (t <= 0.0) return a;
  return t < 1.0 ? a + t * (b - a) : b;
}

/// From `probe` to `segment`.
double PolylineConstraint::distance(Index segment, const Vec3& probe) const noexcept {
  return glm::distance(probe, point(segment, place(segment, probe)));
}

/// Fills `foot` with place `t` of segment_.
void PolylineConstraint::stand_at(double t, Foot& foot) const noexcept {
  foot.point = point(segment_, t);
  foot.axes = frame_along(glm::normalize(vertices_[segment_ + 1] - vertices_[segment_]));
  if (t > 0.0 && t < 1.0) foot.jacobian = glm::outerProduct(foot.axes[0], foot.axes[0]);
}

bool PolylineConstraint::catch_foot(const Vec3& probe, int iterations, Foot& foot) noexcept {
  const Index segments = vertices_.size() - 1;
  for (; next_ < segments; ++next_) {
    if (foot.iterations >= iterations) return false;
    ++foot.iterations;
    const double there = distance(next_, probe);
    if (next_ == 0 || there < nearest_) {
      nearest_ = there;
      segment_ = next_;
    }
  }
  next_ = 0;
  stand_at(place(segment_, probe), foot);
  return true;
}

void PolylineConstraint::follow_foot(const Vec3& probe, int iterations, Foot& foot) noexcept {
  const Index segments = vertices_.size() - 1;
  double nearest = distance(segment_, probe);
  for (;;) {
    Index best = segment_;
    const auto consider = [&](Index segment) {
      const double there = distance(segment, probe);
      if (!(there < nearest)) return;
      nearest = there;
      best = segment;
    };
    if (segment_ + 1 < segments) consider(segment_ + 1);
    if (segment_ > 0) consider(segment_ - 1);
    if (best == segment_) break;
    if (++foot.iterations >= iterations) {
      foot.certain = false;
      break;
    }
    segment_ = best;
  }
  stand_at(place(segment_, probe), foot);
}

}  // namespace palpate
