#include "common/render/tensor/tensor_voxels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/field/grid/grid_from_data.h"
#include "common/field/tensor/diffusion_measures.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

/// @pre x is not NaN.
std::uint8_t byte_of(double x) {
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(x, 0.0, 1.0)));
}

Box box_around(const TensorVoxels& voxels, const Index3& first, const Index3& last) {
  const Vec3 lower = Vec3(first) - 0.5, upper = Vec3(last) + 0.5;
  Box box;
  for (unsigned i = 0; i < 8; ++i) {
    box.include(voxels.position({(i & 1U) != 0 ? upper.x : lower.x, (i & 2U) != 0 ? upper.y : lower.y,
                                 (i & 4U) != 0 ? upper.z : lower.z}));
  }
  return box;
}

void find_shown(TensorVoxels& voxels) {
  const Index3 n = voxels.points;
  Index3 first = n, last{-1};
  Index3 at{0};
  for (at.z = 0; at.z < n.z; ++at.z) {
    for (at.y = 0; at.y < n.y; ++at.y) {
      for (at.x = 0; at.x < n.x; ++at.x) {
        if (!voxels.shows(at)) continue;
        first = glm::min(first, at);
        last = glm::max(last, at);
      }
    }
  }
  const bool any = last.x >= 0;
  voxels.first_shown = any ? first : Index3{0};
  voxels.last_shown = any ? last : n - 1;
}

}  // namespace

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

Rgb direction_color(const Vec3& direction) noexcept { return {glm::abs(direction)}; }

Vec3 TensorVoxels::grid_coordinates(const Vec3& x) const noexcept {
  return GridFromData(axes, origin).point(x);
}

bool TensorVoxels::contains(const Vec3& g) const noexcept {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(g[axis] >= -0.5 && g[axis] <= points[axis] - 0.5)) return false;
  }
  return true;
}

bool TensorVoxels::shows(const Index3& voxel) const noexcept {
  if (directions.empty()) return false;
  const auto row = as_size(points.x);
  const auto line = as_size(voxel.y) + as_size(points.y) * as_size(voxel.z);
  return directions[as_size(voxel.x) + row * line][3] != 0;
}

Box TensorVoxels::bounds() const noexcept { return box_around(*this, Index3{0}, points - 1); }
Box TensorVoxels::shown_bounds() const noexcept { return box_around(*this, first_shown, last_shown); }

std::shared_ptr<const TensorVoxels> make_tensor_voxels(std::shared_ptr<const TensorField> field,
                                                       const std::string& file, int threads) {
  if (!field->voxels()) {
    throw input_error({file, "tensors", "do not stand on a uniform grid", "an image of evenly spaced voxels",
                       "resample it first"});
  }
  auto image = std::make_shared<TensorVoxels>();
  image->points = field->voxels()->points;
  image->origin = field->voxels()->origin;
  image->axes = field->voxels()->axes;
  const Index3 n = image->points;
  const auto row = as_size(n.x);
  const std::size_t rows = as_size(n.y) * as_size(n.z);
  image->directions.resize(row * rows);
  image->anisotropies.resize(row * rows);
  parallel_for(rows, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t r = first; r < last; ++r) {
      for (int i = 0; i < n.x; ++i) {
        const auto y = static_cast<int>(r % as_size(n.y));
        const auto z = static_cast<int>(r / as_size(n.y));
        const TensorSample sample = field->voxel({i, y, z});
        if (sample.status != SampleStatus::kOk) continue;
        const SymmetricEigen eigen = symmetric_eigen(sample.value);
        if (!(eigen.values[0] > 0.0)) continue;
        const double anisotropy = fractional_anisotropy(eigen.values);
        const Vec3 color = anisotropy * Vec3(direction_color(eigen.vectors[0]));
        const std::size_t voxel = r * row + as_size(i);
        image->directions[voxel] = {byte_of(color.r), byte_of(color.g), byte_of(color.b), 255};
        image->anisotropies[voxel] = byte_of(anisotropy);
      }
    }
  });
  find_shown(*image);
  image->field = std::move(field);
  return image;
}

std::shared_ptr<const TensorVoxels> make_slice_lattice(const VolumeImage& image) {
  auto lattice = std::make_shared<TensorVoxels>();
  lattice->points = image.points;
  lattice->origin = image.origin;
  lattice->axes = image.axes;
  lattice->last_shown = image.points - 1;
  return lattice;
}

}  // namespace palpate
