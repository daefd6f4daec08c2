/// What can be edited of anisotropy drag. Apart from anisotropy_drag.h, which needs all settings.
#pragma once

#include <cmath>

#include "common/haptics/transfer_function.h"

namespace palpate {

struct AnisotropySettings {
  /// tau of eqs. 8.6 to 8.11: drag threshold [m] over a sum of anisotropies in [0, 1]. It is 0 at 0 and never
  /// falls: axes along which nothing is anisotropic are free, whichever way they lie.
  HapticTransferFunction tau{{0.0, 0.0}, {1.0, 0.008}};

  bool operator==(const AnisotropySettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return tau(0.0) == 0.0 && tau.lowest() >= 0.0 && tau.rising() && std::isfinite(tau.highest());
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("anisotropy.tau", self.tau);
  }
};

}  // namespace palpate
