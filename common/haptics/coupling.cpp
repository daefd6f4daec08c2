#include "common/haptics/coupling.h"

#include <algorithm>
#include <cmath>

#include "common/base/text.h"

namespace palpate {

StiffnessBound stiffness_bound(const WallLoop& loop, double damping) noexcept {
  StiffnessBound bound{HUGE_VAL, StiffnessLimit::kHold};
  const auto lower = [&bound](double stiffness, StiffnessLimit limit) {
    const double most = std::max(stiffness, 0.0);
    if (most < bound.stiffness) bound = {most, limit};
  };
  if (loop.delay > 0.0) {
    lower((loop.damping + damping) / (0.5 * loop.period + loop.delay), StiffnessLimit::kDelay);
  } else {
    lower(2.0 * (loop.damping - std::abs(damping)) / loop.period, StiffnessLimit::kHold);
  }
  if (loop.encoder_step > 0.0) lower(2.0 * loop.friction / loop.encoder_step, StiffnessLimit::kEncoder);
  if (loop.device_stiffness > 0.0) lower(loop.device_stiffness, StiffnessLimit::kDevice);
  return bound;
}

std::string stiffness_warning(const WallLoop& loop, double stiffness, double damping) {
  const StiffnessBound bound = stiffness_bound(loop, damping);
  if (!(stiffness > bound.stiffness)) return {};
  const std::string text = "a stiffness of " + short_number(stiffness) + " N/m is above " +
                           short_number(bound.stiffness) + " N/m, ";
  switch (bound.limit) {
    case StiffnessLimit::kDevice:
      return text + "the most that is stated for this device";
    case StiffnessLimit::kHold:
      return text + "twice the free damping of " + short_number(loop.damping - std::abs(damping)) +
             " N s/m over the servo's period: an unheld arm may start to swing";
    case StiffnessLimit::kEncoder:
      return text + "twice the friction of " + short_number(loop.friction) +
             " N over the encoder's step of " + short_number(1e3 * loop.encoder_step) +
             " mm: an unheld arm may buzz";
    case StiffnessLimit::kDelay:
      break;
  }
  return text + "what a delay of " + short_number(1e3 * loop.delay) +
         " ms leaves: an unheld arm may start to swing";
}

std::string tuned_note(double asked, double most) {
  return "a stiffness of " + short_number(asked) + " N/m is held to " + short_number(most) +
         " N/m, what tuning found that the device bears";
}

}  // namespace palpate
