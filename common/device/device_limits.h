/// What a device may be asked to do, and how careful its operator wants it to be. The safety stage
/// (servo/safety_stage.h) holds every force to it.
#pragma once

#include <cmath>

#include <glm/vector_relational.hpp>

#include "common/math/vec.h"

namespace palpate {

/// The defaults suit what shows no force, a mouse or a path; the profile of a device that does names its own.
struct DeviceLimits {
  double force_cap = 4.0;           ///< [N] largest force
  double slew_cap = 200.0;          ///< [N/s] fastest growth and turn of the force
  double velocity_gate = HUGE_VAL;  ///< [m/s] a faster hand gets no force until it is armed again
  double stale_after = 0.1;         ///< [s] an older sample gets no force
  double start_ramp = 0.0;          ///< [s] over which the cap grows from zero after a start or a fault
  double fade_time = 0.050;         ///< [s] over which the force fades out on stale samples and on release

  double continuous_cap = HUGE_VAL;  ///< [N] largest force that may last: its motors grow warm
  double heating_time = 1.0;         ///< [s] time constant of that warming

  Vec3 reach_lower{-HUGE_VAL};    ///< [m] corners of the box in which the hand can be: there is no force
  Vec3 reach_upper{HUGE_VAL};     ///< outside of it
  double edge_margin = 0.005;     ///< [m] from its border within which the hand is pushed back
  double edge_stiffness = 200.0;  ///< [N/m] of that push

  int enabling_button = kNoButton;  ///< there is force only while it is held
  bool latch_faults = false;        ///< a fault lasts until the force is armed again

  static constexpr int kNoButton = -1;  ///< no button is needed
  static constexpr int kButtons = 32;   ///< bits of DeviceSample::buttons

  bool operator==(const DeviceLimits&) const = default;

  /// Whether every value can be used: caps and times positive, ramp, fade, margin and stiffness zero at
  /// least, all finite but gate, age, continuous cap and reach.
  [[nodiscard]] bool valid() const noexcept {
    const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
    const auto not_negative = [](double x) { return std::isfinite(x) && x >= 0.0; };
    return positive(force_cap) && positive(slew_cap) && velocity_gate > 0.0 && stale_after > 0.0 &&
           not_negative(start_ramp) && not_negative(fade_time) && continuous_cap > 0.0 &&
           positive(heating_time) && glm::all(glm::lessThan(reach_lower, reach_upper)) &&
           not_negative(edge_margin) && not_negative(edge_stiffness) && enabling_button >= kNoButton &&
           enabling_button < kButtons;
  }
};

}  // namespace palpate
