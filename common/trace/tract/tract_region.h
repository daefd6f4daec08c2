/// A region of space that tracts must enter, must not enter, or end at.
#pragma once

#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "common/field/voxel_mask.h"
#include "common/math/vec.h"

namespace palpate {

/// A ball, data coordinates.
struct Sphere {
  Vec3 center{0.0};
  double radius = 0.0;
};

/// What a round brush has painted: the balls about points along its way, data coordinates.
struct BrushStroke {
  double radius = 0.0;
  std::vector<Vec3> centers;
};

/// All x with normal . x > offset, data coordinates.
struct HalfSpace {
  Vec3 normal{1.0, 0.0, 0.0};
  double offset = 0.0;
};

class TractRegion {
 public:
  explicit TractRegion(const Sphere& sphere) : shape_(sphere) {}
  explicit TractRegion(const Box& box) : shape_(box) {}
  explicit TractRegion(const HalfSpace& beyond) : shape_(beyond) {}
  explicit TractRegion(BrushStroke stroke) : shape_(std::move(stroke)) {}
  explicit TractRegion(std::shared_ptr<const VoxelMask> mask) : shape_(std::move(mask)) {}

  /// Data coordinates. Borders belong to spheres, boxes and strokes. False beyond the image of a mask. @rt Safe.
  [[nodiscard]] bool contains(const Vec3& x_data) const noexcept;

 private:
  std::variant<Sphere, Box, HalfSpace, BrushStroke, std::shared_ptr<const VoxelMask>> shape_;
};

}  // namespace palpate
