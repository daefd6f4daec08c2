#include "common/trace/tract/tract_region.h"

namespace palpate {
namespace {

bool holds(const Sphere& sphere, const Vec3& x) noexcept {
  return glm::distance(x, sphere.center) <= sphere.radius;
}

bool holds(const MaskRegion& region, const Vec3& x) noexcept {
  CellHint hint;
  const ScalarSample sample = region.mask->sample(x, hint);
  return sample.status == SampleStatus::kOk && sample.value > 0.5;
}

}  // namespace

bool TractRegion::contains(const Vec3& x_data) const noexcept {
  return std::visit([&](const auto& shape) { return holds(shape, x_data); }, shape_);
}

}  // namespace palpate
