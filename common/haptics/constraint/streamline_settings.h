/// What can be edited of a streamline that is followed. Apart from streamline.h, which needs all settings.
#pragma once

#include <cmath>

namespace palpate {

struct StreamlineSettings {
  double release_distance = 0.010;  ///< stretch at which it lets go [m]
  double speed_force = 0.0;         ///< [N] along the line where the flow is fastest; negative: against it

  bool operator==(const StreamlineSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return std::isfinite(release_distance) && release_distance > 0.0 && std::isfinite(speed_force);
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("streamline.release", self.release_distance);
    visit("streamline.speed_force", self.speed_force);
  }
};

}  // namespace palpate
