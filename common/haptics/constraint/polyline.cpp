#include "common/haptics/constraint/polyline.h"

#include <algorithm>
#include <utility>

#include "common/base/check.h"
#include "common/haptics/frame_along.h"

namespace palpate {

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
