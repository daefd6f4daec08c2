/// What can be edited of tick marks. Apart from tick_marks.h, which needs all settings.
#pragma once

#include <cmath>

namespace palpate {

struct TickSettings {
  double interval = 0.0;    ///< time of the flow between two marks [data units]; 0: none
  double stiffness = 0.25;  ///< kappa of the marks, in [0, 1]

  bool operator==(const TickSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return std::isfinite(interval) && interval >= 0.0 && stiffness >= 0.0 && stiffness <= 1.0;
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("ticks.interval", self.interval);
    visit("ticks.stiffness", self.stiffness);
  }
};

}  // namespace palpate
