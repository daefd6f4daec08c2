#include "common/hand/stiffness_limits.h"

#include <cmath>

#include "common/base/text.h"
#include "common/servo/wall_loop.h"

namespace palpate {

std::string StiffnessLimits::note(const ChainSettings& asked) const {
  if (asked.stiffness > options_.most_stiffness) return tuned_note(asked.stiffness, options_.most_stiffness);
  if (!options_.simulated) return {};
  return stiffness_warning(wall_loop(options_.simulated->profile, options_.servo_rate), asked.stiffness,
                           asked.damping);
}

std::string StiffnessLimits::text(const ChainSettings& asked) const {
  if (std::isfinite(options_.most_stiffness))
    return "tuned: up to " + short_number(options_.most_stiffness) + " N/m";
  if (!options_.simulated) return {};
  const StiffnessBound bound =
      stiffness_bound(wall_loop(options_.simulated->profile, options_.servo_rate), asked.damping);
  return "passive up to " + short_number(bound.stiffness) + " N/m (" + std::string(name_of(bound.limit)) +
         ")";
}

}  // namespace palpate
