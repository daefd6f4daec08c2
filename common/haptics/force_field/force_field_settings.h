/// What can be edited of the force-field modes. Apart from force_field.h, which needs all settings.
#pragma once

#include <cmath>

namespace palpate {

struct ForceFieldSettings {
  double strength = 1.0;     ///< [N] of direct display where the flow is fastest, and of a strong vortex
  double damping = 5.0;      ///< [N s/m] of transverse damping, and of density drag at the highest value
  double fade_speed = 0.05;  ///< part of the largest speed below which transverse damping fades, in (0, 1]

  bool operator==(const ForceFieldSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return std::isfinite(strength) && std::isfinite(damping) && damping >= 0.0 && fade_speed > 0.0 &&
           fade_speed <= 1.0;
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("force_field.strength", self.strength);
    visit("force_field.damping", self.damping);
    visit("force_field.fade_speed", self.fade_speed);
  }
};

}  // namespace palpate
