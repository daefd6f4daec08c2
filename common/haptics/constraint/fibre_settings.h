/// What can be edited of fibres that are felt on a layer. Apart from the constraints, which need all
/// settings.
#pragma once

#include <cmath>

namespace palpate {

struct FibreSettings {
  double spacing = 0.004;  ///< of the grooves: stretch across a fibre at which the next one catches [m]
  double least_friction = 0.0005;  ///< tau_min: drag threshold where fibres lie in the layer [m]
  double most_friction = 0.006;    ///< tau_max: where they stand on it [m]

  bool operator==(const FibreSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return std::isfinite(spacing) && spacing > 0.0 && least_friction >= 0.0 &&
           most_friction >= least_friction && std::isfinite(most_friction);
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("fibre.spacing", self.spacing);
    visit("fibre.least_friction", self.least_friction);
    visit("fibre.most_friction", self.most_friction);
  }
};

}  // namespace palpate
