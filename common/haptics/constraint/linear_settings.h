/// What can be edited of a linear constraint. Apart from linear.h, which needs all settings.
#pragma once

#include <array>
#include <cmath>

#include "common/haptics/axis_rule.h"
#include "common/haptics/transfer_function.h"

namespace palpate {

/// One axis. The measures that the transfer functions take are chosen where the constraint is made.
struct LinearAxis {
  AxisRule rule = AxisRule::kFree;
  HapticTransferFunction kappa{1.0};  ///< stiffness factor, in [0, 1]
  HapticTransferFunction tau{0.004};  ///< drag threshold [m], >= 0

  bool operator==(const LinearAxis&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return kappa.lowest() >= 0.0 && kappa.highest() <= 1.0 && tau.lowest() >= 0.0 &&
           std::isfinite(tau.highest());
  }
};

struct LinearSettings {
  std::array<LinearAxis, 3> axes;  ///< free, all of them
  double friction = 0.0;           ///< growth of drag thresholds with what presses, >= 0 (axis_rule.h)
  double fade_distance = 0.002;    ///< way over which it lets go where the data ends [m], > 0

  bool operator==(const LinearSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return axes[0].valid() && axes[1].valid() && axes[2].valid() && friction >= 0.0 &&
           std::isfinite(friction) && fade_distance > 0.0 && std::isfinite(fade_distance);
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("linear.1.rule", self.axes[0].rule);
    visit("linear.1.kappa", self.axes[0].kappa);
    visit("linear.1.tau", self.axes[0].tau);
    visit("linear.2.rule", self.axes[1].rule);
    visit("linear.2.kappa", self.axes[1].kappa);
    visit("linear.2.tau", self.axes[1].tau);
    visit("linear.3.rule", self.axes[2].rule);
    visit("linear.3.kappa", self.axes[2].kappa);
    visit("linear.3.tau", self.axes[2].tau);
    visit("linear.friction", self.friction);
    visit("linear.fade", self.fade_distance);
  }
};

}  // namespace palpate
