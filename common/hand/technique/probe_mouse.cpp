#include "common/hand/technique/probe_mouse.h"

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

/// Data units that a pixel covers at `x`.
double units_per_pixel(const Camera& camera, const PictureSize& size, const Vec3& x) {
  const double pixel = camera.view_height / size.height;
  if (camera.projection == Projection::kOrthographic) return pixel;
  // Never nearer than a hundredth of the focal distance, where a pixel would cover nothing.
  constexpr double kNearest = 0.01;
  const double depth = glm::dot(eye(camera) - x, camera.axes[2]) / distance(camera);
  return pixel * std::max(depth, kNearest);
}

Vec3 unit_axis(int axis) {
  Vec3 e{0.0};
  e[axis] = 1.0;
  return e;
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

Vec3 dragged(const Camera& camera, const PictureSize& size, const Vec3& from, double dx, double dy,
             std::optional<int> axis) {
  const double unit = units_per_pixel(camera, size, from);
  const double right = unit * dx, up = -unit * dy;
  if (!axis) return from + right * camera.axes[0] + up * camera.axes[1];
  // The step along the axis whose picture is nearest to that of the mouse.
  const Vec3 e = unit_axis(*axis);
  const double ex = glm::dot(e, camera.axes[0]), ey = glm::dot(e, camera.axes[1]);
  // An axis that is seen end on has no direction in the picture.
  constexpr double kEndOn = 0.05;
  const double seen = std::max(ex * ex + ey * ey, kEndOn * kEndOn);
  return from + ((right * ex + up * ey) / seen) * e;
}

Vec3 pushed(const Camera& camera, const Vec3& from, double notches, std::optional<int> axis) {
  constexpr double kStep = 0.02;  // heights of the view
  const Vec3 away = -camera.axes[2];
  Vec3 direction = away;
  if (axis) {
    direction = unit_axis(*axis);
    if (glm::dot(direction, away) < 0.0) direction = -direction;
  }
  return from + (notches * kStep * camera.view_height) * direction;
}

Vec3 at_depth_of(const Camera& camera, const Vec3& x, const Vec3& depth_of) {
  const Vec3& back = camera.axes[2];
  if (camera.projection == Projection::kOrthographic) return x + glm::dot(depth_of - x, back) * back;
  const Vec3 viewer = eye(camera);
  const double depth = glm::dot(viewer - x, back), wanted = glm::dot(viewer - depth_of, back);
  if (!(depth > 0.0) || !(wanted > 0.0)) return x;
  return viewer + (wanted / depth) * (x - viewer);
}

Vec3 under_mouse(const Camera& camera, const PictureSize& size, const PicturePoint& mouse,
                 const Vec3& depth_of) {
  const Vec3 shown = project(camera, depth_of, size.width, size.height);
  return dragged(camera, size, depth_of, mouse.x - shown.x, mouse.y - shown.y, std::nullopt);
}

}  // namespace palpate
