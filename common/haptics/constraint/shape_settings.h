/// What can be edited of the shapes that widgets are made of (shape.h, which needs all settings).
#pragma once

#include <cmath>

namespace palpate {

struct ShapeSettings {
  double snap_distance = 0.005;     ///< a probe that comes this near is held [m]
  double release_distance = 0.010;  ///< stretch at which it is let go, no less than the former [m]

  bool operator==(const ShapeSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return snap_distance > 0.0 && release_distance >= snap_distance && std::isfinite(release_distance);
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("shape.snap", self.snap_distance);
    visit("shape.release", self.release_distance);
  }
};

}  // namespace palpate
