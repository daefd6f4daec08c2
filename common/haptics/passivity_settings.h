/// What can be edited of the passivity controller. Apart from passivity.h, so that settings need no more.
#pragma once

#include <cmath>

namespace palpate {

struct PassivitySettings {
  double from_links = 2.0;    ///< chains of that many links and more are controlled; a large number: none
  double max_damping = 20.0;  ///< largest alpha [N s/m]; safe while it stays below m / T of the device
  double dead_speed = 1e-4;   ///< [m/s] a slower hand is not damped: there alpha would be that of noise

  bool operator==(const PassivitySettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return std::isfinite(from_links) && std::isfinite(max_damping) && max_damping >= 0.0 &&
           std::isfinite(dead_speed) && dead_speed >= 0.0;
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("passivity.from_links", self.from_links);
    visit("passivity.max_damping", self.max_damping);
    visit("passivity.dead_speed", self.dead_speed);
  }
};

}  // namespace palpate
