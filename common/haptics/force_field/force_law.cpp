#include "common/haptics/force_field/force_law.h"

#include <algorithm>

#include "common/haptics/fade.h"
#include "common/haptics/frame_along.h"

namespace palpate {

double density_part(double value, double lowest, double highest) noexcept {
  if (!(highest > lowest)) return 0.0;
  return std::clamp((value - lowest) / (highest - lowest), 0.0, 1.0);
}

Vec3 direct_force(const Vec3& v, const FlowScale& scale, double strength) noexcept {
  return scale.speed > 0.0 ? strength * (v / scale.speed) : Vec3{0.0};
}

Vec3 lamb_vector(const Vec3& omega, const Vec3& v, const FlowScale& scale) noexcept {
  // Each in its own unit first: the product of both in data units may overflow or vanish.
  return scale.speed > 0.0 && scale.vorticity > 0.0 ? glm::cross(omega / scale.vorticity, v / scale.speed)
                                                    : Vec3{0.0};
}

Vec3 vortex_force(const Vec3& omega, const Vec3& v, const FlowScale& scale, double strength) noexcept {
  if (!(scale.lamb > 0.0)) return Vec3{0.0};
  const Vec3 w = lamb_vector(omega, v, scale) / scale.lamb;
  return strength * (w / std::max(1.0, glm::length(w)));
}

AxisDrag transverse_drag(const Vec3& v, const FlowScale& scale, double damping, double fade_speed) noexcept {
  if (!(scale.speed > 0.0)) return {};
  const Vec3 scaled = v / scale.speed;
  const double speed = glm::length(scaled);
  if (!(speed > 0.0)) return {};
  const double b = damping * fade(speed / fade_speed);
  return {frame_along(scaled / speed), Vec3{0.0, b, b}};
}

}  // namespace palpate
