/// How deep a probe is behind an isosurface, as it was estimated before proxies were put on the surface
/// itself (Ikits 2006, sec. 2.3.3). The object lies where s > s0.
///
///   by value    d = c (s(x) - s0)                                                                   (2.7)
///   by path     d = sum_i n_i . (x_i - x_(i-1)),   n = grad s / |grad s|, into the object            (2.8)
///
/// (2.7) is right to first order in the depth, and only where |grad s| = 1 / c. (2.8) adds up along the path
/// of the probe: it is right where n is the gradient of something, as of a sphere, and elsewhere depends on
/// the way that the probe took, so that its error grows with time.
#pragma once

#include "common/math/vec.h"

namespace palpate {

/// (2.7). @param slope |grad s| of which c is the inverse, > 0
[[nodiscard]] inline double depth_by_value(double value, double isovalue, double slope) noexcept {
  return (value - isovalue) / slope;
}

/// (2.8), one probe after another.
class DepthByPath {
 public:
  /// Begins at the surface.
  explicit DepthByPath(const Vec3& entry) noexcept : last_(entry) {}

  /// @param gradient of s at `probe`; where it vanishes the depth stays as it is
  void move(const Vec3& probe, const Vec3& gradient) noexcept {
    const double slope = glm::length(gradient);
    if (slope > 0.0) depth_ += glm::dot(gradient, probe - last_) / slope;
    last_ = probe;
  }
  [[nodiscard]] double depth() const noexcept { return depth_; }

 private:
  Vec3 last_;
  double depth_ = 0.0;
};

}  // namespace palpate
