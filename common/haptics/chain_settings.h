/// What can be edited while the hand is held, without letting go. Workspace units unless stated.
#pragma once

#include <cmath>

namespace palpate {

struct ChainSettings {
  double stiffness = 200.0;         ///< k of the coupling [N/m]
  double release_distance = 0.010;  ///< stretch at which a streamline lets go [m]
  double drag_threshold = 0.004;    ///< tau of isotropic drag [m]
  double tick_interval = 0.0;       ///< time of the flow between tick marks [data units]; 0: none
  double tick_stiffness = 0.25;     ///< kappa of the tick marks, in [0, 1]
  double speed_force = 0.0;         ///< [N] along the line where the flow is fastest; negative: against it

  bool operator==(const ChainSettings&) const = default;

  /// Whether every value can be used: finite, none below its least, kappa at most one.
  [[nodiscard]] bool valid() const noexcept {
    return std::isfinite(stiffness) && stiffness >= 0.0 && std::isfinite(release_distance) &&
           release_distance > 0.0 && std::isfinite(drag_threshold) && drag_threshold >= 0.0 &&
           std::isfinite(tick_interval) && tick_interval >= 0.0 && tick_stiffness >= 0.0 &&
           tick_stiffness <= 1.0 && std::isfinite(speed_force);
  }
};

}  // namespace palpate
