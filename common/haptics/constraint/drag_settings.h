/// What can be edited of isotropic drag. Apart from isotropic_drag.h, which needs all settings.
#pragma once

#include <cmath>

namespace palpate {

struct DragSettings {
  double threshold = 0.004;  ///< tau: distance at which the proxy follows [m]

  bool operator==(const DragSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept { return std::isfinite(threshold) && threshold >= 0.0; }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("drag.threshold", self.threshold);
  }
};

}  // namespace palpate
