#include "common/field/voxel_mask.h"

#include <cmath>

#include "common/base/check.h"
#include "common/math/lattice.h"

namespace palpate {
namespace {

constexpr double kInside = 0.5;

/// The voxel that holds the place `index` of an image, counted in voxels; false where there is none.
bool nearest_voxel(const Vec3& index, const Index3& points, Index3& voxel) noexcept {
  for (int axis = 0; axis < 3; ++axis) {
    const double nearest = std::floor(index[axis] + 0.5);
    if (!(nearest >= 0.0 && nearest < points[axis])) return false;
    voxel[axis] = static_cast<int>(nearest);
  }
  return true;
}

template <typename Visit>
void visit_centers(const UniformTopology& image, const Visit& visit) {
  std::size_t voxel = 0;
  for (int k = 0; k < image.points.z; ++k) {
    for (int j = 0; j < image.points.y; ++j) {
      for (int i = 0; i < image.points.x; ++i, ++voxel)
        visit(voxel, image.origin + image.axes * Vec3(i, j, k));
    }
  }
}

}  // namespace

VoxelMask::VoxelMask(const UniformTopology& voxels, const DataArray& values)
    : voxels_(voxels), index_from_data_(glm::inverse(voxels.axes)), inside_(values.tuples) {
  PALPATE_CHECK(values.tuples == count_of(voxels.points));
  for (std::size_t v = 0; v < inside_.size(); ++v) {
    inside_[v] = values.at(v) > kInside ? 1 : 0;  // NaN is not
    size_ += inside_[v];
  }
}

bool VoxelMask::contains(const Vec3& x) const noexcept {
  Index3 voxel{0};
  return nearest_voxel(index_from_data_ * (x - voxels_.origin), voxels_.points, voxel) &&
         inside_[index_in(voxels_.points, voxel)] != 0;
}

bool VoxelMask::covers(const Vec3& x) const noexcept {
  Index3 voxel{0};
  return nearest_voxel(index_from_data_ * (x - voxels_.origin), voxels_.points, voxel);
}

std::size_t VoxelMask::size_in(const UniformTopology& image) const noexcept {
  const Mat3 index_from_data = glm::inverse(image.axes);
  std::size_t count = 0;
  visit_centers(voxels_, [&](std::size_t v, const Vec3& x) {
    Index3 voxel{0};
    if (inside_[v] != 0 && nearest_voxel(index_from_data * (x - image.origin), image.points, voxel)) ++count;
  });
  return count;
}

MaskedVoxels masked_voxels(const VoxelMask& mask, const UniformTopology& image) {
  MaskedVoxels masked;
  visit_centers(image, [&](std::size_t, const Vec3& x) {
    masked.inside.push_back(mask.contains(x) ? 1 : 0);
    masked.taken += masked.inside.back();
    masked.beyond += mask.covers(x) ? 0 : 1;
  });
  return masked;
}

}  // namespace palpate
