#include "common/render/tensor/underlay_view.h"

#include <array>
#include <cmath>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/grid/grid_from_data.h"

namespace palpate {
namespace {

constexpr std::array<std::string_view, kUnderlayBlendCount> kBlends{"anisotropy", "solid", "none"};

}  // namespace

std::string_view name_of(UnderlayBlend blend) noexcept { return kBlends[as_size(blend)]; }

UnderlayBlend underlay_blend_from_name(std::string_view name) {
  return static_cast<UnderlayBlend>(find_word(kBlends, name, "blend"));
}

std::optional<double> voxel_value(const VolumeImage& image, const Vec3& x) noexcept {
  const Vec3 g = glm::floor(GridFromData(image.axes, image.origin).point(x) + 0.5);
  for (int axis = 0; axis < 3; ++axis) {
    if (!(g[axis] >= 0.0 && g[axis] < image.points[axis])) return std::nullopt;
  }
  const auto at = [](double part) { return static_cast<std::size_t>(part); };
  const double value = image.value(at(g.x) + at(image.points.x) * (at(g.y) + at(image.points.y) * at(g.z)));
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace palpate
