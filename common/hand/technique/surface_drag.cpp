#include "common/hand/technique/surface_drag.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

/// Samples to either side of a place, along its line of sight.
constexpr int kSightSamples = 96;
constexpr int kSightBisections = 50;
/// A wall that is seen at this slope is followed: ten times as far along the view as across it.
constexpr double kSteepestSight = 10.0;
/// However little the mouse was moved [diagonals].
constexpr double kLeastReach = 1e-3;

Vec3 line_of_sight(const Camera& camera, const Vec3& x) {
  return camera.projection == Projection::kOrthographic ? -camera.axes[2] : glm::normalize(x - eye(camera));
}

/// How far along `away` from `x` the surface lies at the nearest place where the value passes its level as
/// `rising` says; none within `reach`.
std::optional<double> nearest_crossing(const HeldSurface& surface, const Vec3& x, const Vec3& away,
                                       bool rising, double reach) {
  CellHint hint;
  const auto above = [&](double t) {
    const ScalarSample sample = surface.field.sample(x + t * away, hint);
    return sample.status == SampleStatus::kOk ? sample.value - surface.level : std::nan("");
  };
  const double step = reach / kSightSamples;
  const auto between = [&](double low, double high) {
    for (int i = 0; i < kSightBisections; ++i) {
      const double middle = 0.5 * (low + high);
      ((above(middle) >= 0.0) == rising ? high : low) = middle;
    }
    return 0.5 * (low + high);
  };
  const auto crosses = [&](double before, double after) {
    return rising ? before < 0.0 && after >= 0.0 : before >= 0.0 && after < 0.0;
  };
  double behind = above(0.0), before = behind;
  for (int n = 1; n <= kSightSamples; ++n) {
    const double next = above(n * step), last = above(-n * step);
    if (crosses(behind, next)) return between((n - 1) * step, n * step);
    if (crosses(last, before)) return between(-n * step, (1 - n) * step);
    behind = next;
    before = last;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Vec3> dragged_along(const HeldSurface& surface, const Camera& camera, const Vec3& from,
                                  const Vec3& to) {
  CellHint hint;
  const VectorSample gradient = surface.field.gradient(surface.proxy, hint);
  if (gradient.status != SampleStatus::kOk) return std::nullopt;
  const Vec3 sight = line_of_sight(camera, from), away = line_of_sight(camera, to);
  const bool rising = glm::dot(gradient.value, line_of_sight(camera, surface.proxy)) > 0.0;
  const double least = kLeastReach * surface.field.diagonal();
  const auto here = nearest_crossing(surface, from, sight, rising,
                                     least + kSteepestSight * glm::distance(from, surface.proxy));
  if (!here) return std::nullopt;
  const double pressed = -*here;
  const Vec3 beside = to - pressed * away;
  const auto there =
      nearest_crossing(surface, beside, away, rising, least + kSteepestSight * glm::distance(from, to));
  if (!there) return std::nullopt;
  return beside + (*there + pressed) * away;
}

}  // namespace palpate
