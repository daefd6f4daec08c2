/// What can be edited of the force-field modes. Apart from force_field.h, which needs all settings.
#pragma once

#include <cmath>

#include "common/haptics/transfer_function.h"

namespace palpate {

struct ForceFieldSettings {
  double strength = 1.0;     ///< [N] of direct display where the flow is fastest, and of a strong vortex
  double damping = 5.0;      ///< [N s/m] of transverse damping and density drag, where they are full
  double fade_speed = 0.05;  ///< part of the largest speed below which transverse damping fades, in (0, 1]

  /// Part of the damping that density drag has, in [0, 1], by value from 0, the lowest, to 1, the highest.
  HapticTransferFunction density{{0.0, 0.0}, {1.0, 1.0}};

  bool operator==(const ForceFieldSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return std::isfinite(strength) && std::isfinite(damping) && damping >= 0.0 && fade_speed > 0.0 &&
           fade_speed <= 1.0 && density.lowest() >= 0.0 && density.highest() <= 1.0;
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("force_field.strength", self.strength);
    visit("force_field.damping", self.damping);
    visit("force_field.fade_speed", self.fade_speed);
    visit("force_field.density", self.density);
  }
};

}  // namespace palpate
