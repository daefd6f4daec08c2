/// A region of space that tracts must enter, must not enter, or end at.
#pragma once

#include <memory>
#include <variant>

#include "common/field/scalar_field.h"
#include "common/math/vec.h"

namespace palpate {

/// A ball, data coordinates.
struct Sphere {
  Vec3 center{0.0};
  double radius = 0.0;
};

/// The part of an image where its interpolated value is above one half: of a mask of zeros and ones the
/// voxels of ones, with faces half way to their neighbours.
struct MaskRegion {
  std::shared_ptr<const ScalarField> mask;
};

class TractRegion {
 public:
  explicit TractRegion(const Sphere& sphere) : shape_(sphere) {}
  explicit TractRegion(MaskRegion mask) : shape_(std::move(mask)) {}

  /// Data coordinates. Borders belong to a sphere. False where an image has no value. @rt Safe.
  [[nodiscard]] bool contains(const Vec3& x_data) const noexcept;

 private:
  std::variant<Sphere, MaskRegion> shape_;
};

}  // namespace palpate
