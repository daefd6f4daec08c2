/// From data coordinates to those of an image's grid.
///
/// Symbols.  g grid coordinates, whole numbers at the points; x = origin + axes g data coordinates.
#pragma once

#include <algorithm>
#include <cmath>

#include "common/math/power_of_two.h"
#include "common/math/vec.h"

namespace palpate {

class GridFromData {
 public:
  /// @pre axes span a space. Exponents come first: spacings may be tiny.
  GridFromData(const Mat3& axes, const Vec3& origin) : origin_(origin) {
    double largest = 0.0;
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) largest = std::max(largest, std::abs(axes[c][r]));
    }
    unit_ = power_of_two(-binary_exponent(largest));
    inverse_ = glm::inverse(axes * unit_);
  }
  /// g of x.
  [[nodiscard]] Vec3 point(const Vec3& x) const { return inverse_ * ((x - origin_) * unit_); }
  /// Steps of g along v.
  [[nodiscard]] Vec3 direction(const Vec3& v) const { return inverse_ * (v * unit_); }

 private:
  Mat3 inverse_{1.0};
  Vec3 origin_;
  double unit_ = 1.0;
};

}  // namespace palpate
