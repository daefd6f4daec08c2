#include "common/render/stereo/stereo_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/check.h"
#include "common/base/error.h"

namespace palpate {

double angular_disparity(double separation, double z, double d) noexcept {
  return 2.0 * (std::atan(0.5 * separation / z) - std::atan(0.5 * separation / d));
}

double separation_of_disparity(double disparity, double z, double d) noexcept {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double t = std::tan(0.5 * disparity), q = std::abs(1.0 / z - 1.0 / d);
  const double discriminant = q * q - 4.0 * t * t / (z * d);
  if (!(discriminant >= 0.0) || q == 0.0) return kNever;
  // The root in the form that does not cancel.
  return 2.0 * (2.0 * t / (q + std::sqrt(discriminant)));
}

StereoEyes stereo_eyes(const Camera& camera, const StereoView& stereo, const Box& bounds) {
  PALPATE_CHECK(camera.projection == Projection::kPerspective);
  Vec3 middle = eye(camera), half = 0.5 * stereo.separation * distance(camera) * camera.axes[0];
  if (stereo.eyes) {
    middle = 0.5 * ((*stereo.eyes)[0] + (*stereo.eyes)[1]);
    half = 0.5 * ((*stereo.eyes)[1] - (*stereo.eyes)[0]);
  }
  const double d = glm::dot(middle - camera.focal_point, camera.axes[2]), wanted = 2.0 * glm::length(half);
  StereoEyes eyes{.cameras = {camera, camera}, .near_depth = d, .far_depth = d};
  if (!bounds.empty()) {
    // Nothing nearer than this is drawn (view_transform()).
    const double nearest = kNearestDepth * d;
    double near_depth = std::numeric_limits<double>::infinity(), far_depth = 0.0;
    for (unsigned i = 0; i < 8; ++i) {
      const Vec3 corner{(i & 1U) != 0 ? bounds.upper.x : bounds.lower.x,
                        (i & 2U) != 0 ? bounds.upper.y : bounds.lower.y,
                        (i & 4U) != 0 ? bounds.upper.z : bounds.lower.z};
      const double depth = glm::dot(middle - corner, camera.axes[2]);
      near_depth = std::min(near_depth, depth);
      far_depth = std::max(far_depth, depth);
    }
    eyes.near_depth = std::max(near_depth, nearest);
    eyes.far_depth = std::max(far_depth, eyes.near_depth);
  }
  const double e = std::min({wanted, separation_of_disparity(stereo.most_disparity, eyes.near_depth, d),
                             separation_of_disparity(stereo.most_disparity, eyes.far_depth, d)});
  eyes.separation = e / d;
  if (wanted > 0.0) eyes.limited = e / wanted;
  eyes.near_disparity = angular_disparity(e, eyes.near_depth, d);
  eyes.far_disparity = angular_disparity(e, eyes.far_depth, d);
  const Vec3 moved = wanted > 0.0 ? (e / wanted) * half : Vec3(0.0);
  eyes.cameras = {seen_from(camera, middle - moved), seen_from(camera, middle + moved)};
  return eyes;
}

double eye_aspect(StereoMode mode, double width, double height) noexcept {
  if (mode == StereoMode::kSideBySide) return 0.5 * width / height;
  return (mode == StereoMode::kTopBottom ? 2.0 : 1.0) * width / height;
}

EyePictureSize eye_picture_size(StereoMode mode, int width, int height) {
  EyePictureSize size{width, height};
  if (mode == StereoMode::kSideBySide) size.width /= 2;
  if (mode == StereoMode::kTopBottom) size.height /= 2;
  if (size.width < 1 || size.height < 1)
    throw usage_error("a picture of " + std::to_string(width) + "x" + std::to_string(height) +
                      " pixels has no room for two eyes");
  return size;
}

}  // namespace palpate
