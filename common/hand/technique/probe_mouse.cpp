#include "common/hand/technique/probe_mouse.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

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
