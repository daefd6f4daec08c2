#include "common/render/stereo/screen_camera.h"

#include <cmath>

#include "common/base/check.h"

namespace palpate {

Camera screen_camera(const Screen& screen) {
  Camera camera;
  camera.focal_point = center(screen);
  camera.axes = axes(screen);
  camera.view_height = height(screen);
  return camera;
}

Camera seen_from(const Camera& camera, const Vec3& eye) {
  const Vec3 v = (eye - camera.focal_point) * camera.axes;  // along right, up, back
  PALPATE_CHECK(v.z > 0.0);
  Camera moved = camera;
  moved.field_of_view = 2.0 * std::atan(0.5 * camera.view_height / v.z);
  moved.eye_offset = {v.x, v.y};
  return moved;
}

}  // namespace palpate
