#include "common/render/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/base/check.h"
#include "common/math/power_of_two.h"

namespace palpate {
namespace {

// Room between the fitted box and the border of the picture; more of it at the sides, where the colour
// bar stands.
constexpr double kFitMargin = 1.10, kFitMarginAcross = 1.22;

constexpr double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

Vec2 offset_of(const Camera& camera) {
  return camera.projection == Projection::kPerspective ? camera.eye_offset : Vec2(0.0);
}

// Rotation of the axes among themselves: columns of `turn` are the new axes in terms of the old.
void turn_axes(Camera& camera, const Mat3& turn) {
  Mat3 axes = camera.axes * turn;
  // Gram-Schmidt, so that rounding of many small turns does not add up to a sheared picture.
  axes[2] = glm::normalize(axes[2]);
  axes[0] = glm::normalize(axes[0] - glm::dot(axes[0], axes[2]) * axes[2]);
  axes[1] = glm::cross(axes[2], axes[0]);
  camera.axes = axes;
}

// A box that can be looked at: finite, with some size.
Box usable(const Box& bounds) {
  if (bounds.empty() || !is_finite(bounds.lower) || !is_finite(bounds.upper)) {
    return {Vec3(-1.0), Vec3(1.0)};
  }
  const Vec3 size = bounds.size();
  if (std::max({size.x, size.y, size.z}) > 0.0) return bounds;
  const double reach =
      std::max({std::abs(bounds.lower.x), std::abs(bounds.lower.y), std::abs(bounds.lower.z)});
  const double half = reach > 0.0 ? power_of_two(binary_exponent(reach) - 10) : 1.0;
  return {bounds.lower - half, bounds.upper + half};
}

std::array<Vec3, 8> corners(const Box& box) {
  std::array<Vec3, 8> result{};
  for (std::size_t i = 0; i < 8; ++i) {
    result[i] = {(i & 1U) != 0 ? box.upper.x : box.lower.x, (i & 2U) != 0 ? box.upper.y : box.lower.y,
                 (i & 4U) != 0 ? box.upper.z : box.lower.z};
  }
  return result;
}

}  // namespace

Camera make_camera(const Box& bounds, const CameraAngles& angles, double aspect, Projection projection) {
  Camera camera;
  camera.projection = projection;
  const double a = radians(angles.azimuth), e = radians(angles.elevation);
  const Vec3 back{std::sin(a) * std::cos(e), -std::cos(a) * std::cos(e), std::sin(e)};
  const Vec3 right{std::cos(a), std::sin(a), 0.0};
  camera.axes = Mat3(right, glm::cross(back, right), back);
  fit(camera, bounds, aspect);
  roll(camera, radians(angles.roll));
  if (angles.zoom > 0.0 && std::isfinite(angles.zoom)) zoom(camera, angles.zoom);
  return camera;
}

void fit(Camera& camera, const Box& bounds, double aspect) {
  const Box box = usable(bounds);
  camera.focal_point = box.center();
  const double slope = std::tan(0.5 * camera.field_of_view);
  const double across = std::min(1.0, aspect);
  double height = 0.0;
  for (const Vec3& corner : corners(box)) {
    const Vec3 v = (corner - camera.focal_point) * camera.axes;  // transposed product: along r, u, b
    const double reach = std::max(kFitMargin * std::abs(v.y), kFitMarginAcross * std::abs(v.x) / aspect);
    // Perspective: |v.y| <= (d - v.z) tan(alpha/2) for every corner, and (1).
    const double needed =
        camera.projection == Projection::kPerspective ? 2.0 * (reach + v.z * slope) : 2.0 * reach;
    height = std::max(height, needed);
  }
  // A box seen edge-on (a plane from its side) still needs some height.
  const Vec3 size = box.size();
  height = std::max(height, 1e-3 * std::max({size.x, size.y, size.z}) / across);
  camera.view_height = height;
}

void turn(Camera& camera, double to_right, double to_top) {
  const double cy = std::cos(to_right), sy = std::sin(to_right);
  const double cx = std::cos(to_top), sx = std::sin(to_top);
  // The scene follows the mouse, so the camera turns the other way.
  const Mat3 about_up(Vec3(cy, 0.0, sy), Vec3(0.0, 1.0, 0.0), Vec3(-sy, 0.0, cy));
  const Mat3 about_right(Vec3(1.0, 0.0, 0.0), Vec3(0.0, cx, sx), Vec3(0.0, -sx, cx));
  turn_axes(camera, about_up * about_right);
}

void roll(Camera& camera, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  turn_axes(camera, Mat3(Vec3(c, -s, 0.0), Vec3(s, c, 0.0), Vec3(0.0, 0.0, 1.0)));
}

void pan(Camera& camera, double to_right, double to_top) {
  camera.focal_point -= camera.view_height * (to_right * camera.axes[0] + to_top * camera.axes[1]);
}

void zoom(Camera& camera, double factor, double to_right, double to_top) {
  PALPATE_ASSERT(factor > 0.0);
  // The point under the cursor stays there: it moves by (1 - 1/factor) of its offset from the middle.
  const double share = 1.0 - 1.0 / factor;
  pan(camera, -to_right * share, -to_top * share);
  camera.view_height /= factor;
}

double distance(const Camera& camera) noexcept {
  return 0.5 * camera.view_height / std::tan(0.5 * camera.field_of_view);
}

Vec3 eye(const Camera& camera) noexcept {
  const Vec2 o = offset_of(camera);
  return camera.focal_point + distance(camera) * camera.axes[2] + o.x * camera.axes[0] + o.y * camera.axes[1];
}

Vec3 SceneFrame::scene_from_data(const Vec3& x) const noexcept {
  return (x - center) * power_of_two(-exponent);
}

SceneFrame scene_frame(const Box& bounds) noexcept {
  const Box box = usable(bounds);
  const Vec3 size = box.size();
  // longest in [2^k, 2^(k+1)): half of it divided by 2^k lies in [1/2, 1).
  return {box.center(), std::clamp(binary_exponent(std::max({size.x, size.y, size.z})), -1022, 1022)};
}

ViewTransform view_transform(const Camera& camera, const SceneFrame& frame, const Box& bounds,
                             double aspect) {
  const double scale = power_of_two(-frame.exponent);
  const Mat3& axes = camera.axes;
  ViewTransform view;
  view.focal_point = frame.scene_from_data(camera.focal_point);
  view.view_height = camera.view_height * scale;
  view.distance = distance(camera) * scale;
  view.eye_offset = offset_of(camera) * scale;
  view.eye =
      view.focal_point + view.distance * axes[2] + view.eye_offset.x * axes[0] + view.eye_offset.y * axes[1];

  const Box box = usable(bounds);
  const Vec3 middle = frame.scene_from_data(box.center());
  const double radius = 0.5 * glm::length(box.size() * scale);
  const double middle_depth = glm::dot(view.eye - middle, axes[2]);
  view.near_depth = middle_depth - radius;
  view.far_depth = middle_depth + radius;

  Mat4 eye_from_scene(1.0);
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) eye_from_scene[column][row] = axes[row][column];
  }
  eye_from_scene[3] = Vec4(-(view.eye * axes), 1.0);

  // Clip planes a little outside the scene; in perspective never nearer than a part of the distance, so
  // that depth keeps its resolution when the eye is inside the scene.
  constexpr double kClipMargin = 0.02;
  const double margin = kClipMargin * radius + 1e-6 * view.distance;
  double near_plane = view.near_depth - margin, far_plane = view.far_depth + margin;
  Mat4 clip_from_eye(0.0);
  if (camera.projection == Projection::kPerspective) {
    near_plane = std::max(near_plane, kNearestDepth * view.distance);
    far_plane = std::max(far_plane, 2.0 * near_plane);
    const double s = 1.0 / std::tan(0.5 * camera.field_of_view);
    clip_from_eye[0][0] = s / aspect;
    clip_from_eye[1][1] = s;
    // Off-axis: the middle of the picture lies at -o on the focal plane.
    clip_from_eye[2][0] = -view.eye_offset.x / (0.5 * view.view_height * aspect);
    clip_from_eye[2][1] = -view.eye_offset.y / (0.5 * view.view_height);
    clip_from_eye[2][2] = -(far_plane + near_plane) / (far_plane - near_plane);
    clip_from_eye[2][3] = -1.0;
    clip_from_eye[3][2] = -2.0 * far_plane * near_plane / (far_plane - near_plane);
  } else {
    clip_from_eye[0][0] = 2.0 / (view.view_height * aspect);
    clip_from_eye[1][1] = 2.0 / view.view_height;
    clip_from_eye[2][2] = -2.0 / (far_plane - near_plane);
    clip_from_eye[3][2] = -(far_plane + near_plane) / (far_plane - near_plane);
    clip_from_eye[3][3] = 1.0;
  }
  view.clip_from_scene = clip_from_eye * eye_from_scene;
  return view;
}

Vec3 project(const Camera& camera, const Vec3& x, int width, int height) noexcept {
  const Vec3 v = (x - camera.focal_point) * camera.axes;
  const double d = distance(camera);
  const double depth = d - v.z;
  const double enlarge = camera.projection == Projection::kPerspective ? d / depth : 1.0;
  const Vec2 o = offset_of(camera);
  const double pixel = camera.view_height / height;
  // From the eye through the point on to the focal plane.
  const double x_there = o.x + (v.x - o.x) * enlarge, y_there = o.y + (v.y - o.y) * enlarge;
  return {0.5 * width + x_there / pixel, 0.5 * height - y_there / pixel, depth};
}

}  // namespace palpate
