/// The cubic through two points with given unit tangents, as a function of arc length from the first.
///
/// Of a smooth curve parameterised by its arc length it is the Hermite interpolant: its distance from the
/// curve falls with the fourth power of `length`.
#pragma once

#include "common/math/vec.h"

namespace palpate {

struct HermitePiece {
  Vec3 start{0.0}, start_tangent{0.0};
  Vec3 end{0.0}, end_tangent{0.0};
  double length = 0.0;  ///< arc between the ends, > 0

  /// The point at arc `s` in [0, length]: `start` itself at 0, `end` but for rounding at `length`.
  [[nodiscard]] Vec3 at(double s) const noexcept {
    const double u = s / length;
    const Vec3 chord = end - start;
    const Vec3 first = length * start_tangent - chord, last = chord - length * end_tangent;
    return start + u * chord + (u * (1.0 - u)) * ((1.0 - u) * first + u * last);
  }
  /// First derivative by s; nearly of unit length.
  [[nodiscard]] Vec3 tangent(double s) const noexcept {
    const double u = s / length;
    const Vec3 chord = (end - start) / length;
    const Vec3 first = start_tangent - chord, last = chord - end_tangent;
    return chord + ((1.0 - u) * (1.0 - 3.0 * u)) * first + (u * (2.0 - 3.0 * u)) * last;
  }
  /// Second derivative by s.
  [[nodiscard]] Vec3 bend(double s) const noexcept {
    const double u = s / length;
    const Vec3 chord = (end - start) / length;
    const Vec3 first = start_tangent - chord, last = chord - end_tangent;
    return ((6.0 * u - 4.0) * first + (2.0 - 6.0 * u) * last) / length;
  }
};

}  // namespace palpate
