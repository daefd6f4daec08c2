/// What can be edited of a haptic grid. Apart from grid_axis.h, which needs all settings.
#pragma once

#include <cmath>

namespace palpate {

struct GridAxisSettings {
  double threshold = 0.006;  ///< pull across the axis by which another one takes over [m]
  double teeth = 0.0;        ///< kappa of the nodes along the axis, in [0, 1]; 0: it is followed freely

  bool operator==(const GridAxisSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return threshold > 0.0 && std::isfinite(threshold) && teeth >= 0.0 && teeth <= 1.0;
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("grid_axis.threshold", self.threshold);
    visit("grid_axis.teeth", self.teeth);
  }
};

}  // namespace palpate
