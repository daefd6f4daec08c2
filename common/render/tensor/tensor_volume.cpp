#include "common/render/tensor/tensor_volume.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace palpate {

std::shared_ptr<const VolumeImage> make_anisotropy_volume(std::shared_ptr<const TensorVoxels> voxels) {
  constexpr double kOne = 255.0;  // the number that stands for an FA of one
  auto volume = std::make_shared<VolumeImage>();
  volume->points = voxels->points;
  volume->origin = voxels->origin;
  volume->axes = voxels->axes;
  volume->type = ScalarType::kUint8;
  volume->bytes = std::as_bytes(std::span(voxels->anisotropies));
  volume->scale = 1.0 / kOne;
  const auto [least, most] = std::minmax_element(voxels->anisotropies.begin(), voxels->anisotropies.end());
  volume->lowest = *least / kOne;
  volume->highest = *most / kOne;

  // The colours of slices are weighted with FA; that of a voxel without anisotropy has no direction.
  std::vector<std::array<std::uint8_t, 4>> colors = voxels->directions;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const unsigned weight = voxels->anisotropies[i];
    if (weight == 0) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      colors[i][c] = static_cast<std::uint8_t>(std::min(255U, (255U * colors[i][c] + weight / 2) / weight));
    }
  }
  volume->colors = std::make_shared<const std::vector<std::array<std::uint8_t, 4>>>(std::move(colors));
  volume->owner = std::move(voxels);
  return volume;
}

ColorTransfer anisotropy_veil() {
  const Vec3f grey(0.62F, 0.64F, 0.68F), white(1.0F);
  return ColorTransfer({{0.12, grey, 0.0}, {0.3, grey, 0.012}, {0.6, white, 0.05}, {1.0, white, 0.2}});
}

ColorTransfer anisotropy_body() {
  const Vec3f white(1.0F);
  return ColorTransfer({{0.25, white, 0.0}, {0.4, white, 0.5}, {1.0, white, 0.9}});
}

}  // namespace palpate
