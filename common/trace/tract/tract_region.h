/// A region of space that tracts must enter, must not enter, or end at.
#pragma once

#include <memory>
#include <utility>
#include <variant>

#include "common/field/voxel_mask.h"
#include "common/math/vec.h"

namespace palpate {

/// A ball, data coordinates.
struct Sphere {
  Vec3 center{0.0};
  double radius = 0.0;
};

class TractRegion {
 public:
  explicit TractRegion(const Sphere& sphere) : shape_(sphere) {}
  explicit TractRegion(std::shared_ptr<const VoxelMask> mask) : shape_(std::move(mask)) {}

  /// Data coordinates. Borders belong to a sphere. False beyond the image of a mask. @rt Safe.
  [[nodiscard]] bool contains(const Vec3& x_data) const noexcept;

 private:
  std::variant<Sphere, std::shared_ptr<const VoxelMask>> shape_;
};

}  // namespace palpate
