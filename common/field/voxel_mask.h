/// A mask: an image of which each voxel is inside or outside, laid over space by its own affine.
///
/// The one rule of masks, for fits, seeds and regions alike: a point belongs to the nearest voxel, and a voxel
/// is inside where its value is above 0.5. NaN, negative values and all of space beyond the image are outside.
/// How the voxels are stored, and how large they are, does not matter.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/field/data_set.h"
#include "common/math/vec.h"

namespace palpate {

class VoxelMask {
 public:
  /// @pre values.tuples is the product of voxels.points; their axes span space.
  VoxelMask(const UniformTopology& voxels, const DataArray& values);

  /// Data coordinates. @rt Safe.
  [[nodiscard]] bool contains(const Vec3& x) const noexcept;
  /// Whether the nearest voxel is one of the image's, inside or not. @rt Safe.
  [[nodiscard]] bool covers(const Vec3& x) const noexcept;
  [[nodiscard]] const UniformTopology& voxels() const noexcept { return voxels_; }
  /// Voxels that are inside.
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  /// Those of them whose centres lie in a voxel of `image`.
  [[nodiscard]] std::size_t size_in(const UniformTopology& image) const noexcept;

 private:
  UniformTopology voxels_;
  Mat3 index_from_data_{1.0};
  std::vector<std::uint8_t> inside_;
  std::size_t size_ = 0;
};

/// A mask asked at the centres of the voxels of an image.
struct MaskedVoxels {
  std::vector<std::uint8_t> inside;  ///< a byte a voxel of the image, the first axis fastest
  std::size_t taken = 0;             ///< voxels that are inside
  std::size_t beyond = 0;            ///< voxels that the mask's image does not reach
};
[[nodiscard]] MaskedVoxels masked_voxels(const VoxelMask& mask, const UniformTopology& image);

}  // namespace palpate
