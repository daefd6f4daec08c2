#include "common/trace/tract/tract_region.h"

namespace palpate {
namespace {

bool holds(const Sphere& sphere, const Vec3& x) noexcept {
  return glm::distance(x, sphere.center) <= sphere.radius;
}

bool holds(const std::shared_ptr<const VoxelMask>& mask, const Vec3& x) noexcept { return mask->contains(x); }

}  // namespace

bool TractRegion::contains(const Vec3& x_data) const noexcept {
  return std::visit([&](const auto& shape) { return holds(shape, x_data); }, shape_);
}

}  // namespace palpate
