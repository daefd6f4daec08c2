#include "common/trace/tract/tract_region.h"

#include <algorithm>

namespace palpate {
namespace {

bool holds(const Sphere& sphere, const Vec3& x) noexcept {
  return glm::distance(x, sphere.center) <= sphere.radius;
}

bool holds(const Box& box, const Vec3& x) noexcept { return box.contains(x); }

bool holds(const HalfSpace& beyond, const Vec3& x) noexcept {
  return glm::dot(beyond.normal, x) > beyond.offset;
}

bool holds(const BrushStroke& stroke, const Vec3& x) noexcept {
  return std::any_of(stroke.centers.begin(), stroke.centers.end(),
                     [&](const Vec3& center) { return glm::distance(x, center) <= stroke.radius; });
}

bool holds(const std::shared_ptr<const VoxelMask>& mask, const Vec3& x) noexcept { return mask->contains(x); }

}  // namespace

bool TractRegion::contains(const Vec3& x_data) const noexcept {
  return std::visit([&](const auto& shape) { return holds(shape, x_data); }, shape_);
}

}  // namespace palpate
