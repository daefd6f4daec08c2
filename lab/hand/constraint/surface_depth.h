/// How deep a hand is behind an isosurface: the older estimates (Ikits 2006, eqs. 2.7 and 2.8) against the
/// proxy that is on the surface itself.
///
/// The surface is an ellipsoid with half-axes R (1, 0.7, 0.5), the isosurface 0 of 1 - sum (x_a / r_a)^2. A
/// hand slides behind it at 0.1 m/s around the same loop, at a depth d about kMeanDepth: its place is x = q -
/// d n(q), with q on the surface and n its normal there, and q is the nearest point of the surface as long as
/// d is less than the smallest radius of curvature, R / 4. So the true depth is known without any search.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "common/base/progress.h"
#include "common/math/vec.h"
#include "lab/page/section.h"

namespace palpate {

enum class DepthMethod : std::uint8_t { kByValue, kByPath, kProxy };
inline constexpr std::array<DepthMethod, 3> kDepthMethods{DepthMethod::kByValue, DepthMethod::kByPath,
                                                          DepthMethod::kProxy};
[[nodiscard]] std::string_view name_of(DepthMethod method) noexcept;  ///< "by value (2.7)"

struct SurfaceDepthRow {
  DepthMethod method = DepthMethod::kByValue;
  double size = 0.0;     ///< R [m]
  double time = 0.0;     ///< [s] at the end of the interval that the row is about
  double error = 0.0;    ///< largest |estimate - d| in it [m]
  double us_mean = 0.0;  ///< of a step, processor time
};

struct SurfaceDepth {
  std::vector<SurfaceDepthRow> by_time;  ///< at kDepthSize; each interval begins where the one before ends
  std::vector<SurfaceDepthRow> by_size;  ///< in the first turn
};
inline constexpr double kDepthSize = 0.05;   ///< [m]
inline constexpr double kMeanDepth = 0.003;  ///< [m]

/// @throws Cancelled.
[[nodiscard]] SurfaceDepth run_surface_depth(Progress* progress);

[[nodiscard]] ReportSection surface_depth_section(const SurfaceDepth& depth);

// How deep a probe is behind an isosurface, as it was estimated before proxies were put on the surface
// itself (Ikits 2006, sec. 2.3.3). The object lies where s > s0.
//
//   by value    d = c (s(x) - s0)                                                                   (2.7)
//   by path     d = sum_i n_i . (x_i - x_(i-1)),   n = grad s / |grad s|, into the object            (2.8)
//
// (2.7) is right to first order in the depth, and only where |grad s| = 1 / c. (2.8) adds up along the path
// of the probe: it is right where n is the gradient of something, as of a sphere, and elsewhere depends on
// the way that the probe took, so that its error grows with time.

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
