/// The stiffest wall that a device can show without giving energy to the hand.
///
/// Symbols: K virtual stiffness [N/m], B virtual damping [N s/m], b damping of the device [N s/m], f_c its
/// Coulomb friction [N], D step of its encoders [m], T period of the servo [s], t_d delay of the loop beyond
/// the hold [s].
///
///   K <= 2 (b - |B|) / T                passivity of a sampled wall (Colgate & Schenkel 1994)        (1)
///   K <= min(2 b / T, 2 f_c / D)        with encoder steps and friction (Abbott & Okamura 2005)      (2)
///   K <= (b + B) / (T/2 + t_d)          linear stability with delay (Diolaiti et al. 2006)           (3)
///
/// (1) holds whatever the hand does, and so is strict: a hand that holds the device is stable far beyond. (2)
/// without friction allows nothing: a quantum of position is then never lost again. (3) replaces (1) where
/// there is a delay.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/base/index.h"

namespace palpate {

/// The loop that a wall is shown by. All finite and >= 0, the period above zero.
struct WallLoop {
  double damping = 0.0;           ///< b
  double friction = 0.0;          ///< f_c
  double encoder_step = 0.0;      ///< D
  double delay = 0.0;             ///< t_d
  double period = 0.001;          ///< T
  double device_stiffness = 0.0;  ///< that the device's maker allows [N/m]; 0: not known
};

enum class StiffnessLimit : std::uint8_t {
  kDevice,   ///< the maker's
  kHold,     ///< (1)
  kEncoder,  ///< the second part of (2)
  kDelay     ///< (3)
};
[[nodiscard]] constexpr std::string_view name_of(StiffnessLimit limit) noexcept {  ///< "servo's hold"
  constexpr std::array<std::string_view, 4> kNames{"stated for the device", "servo's hold", "encoder steps",
                                                   "delay"};
  return kNames[as_size(limit)];
}

struct StiffnessBound {
  double stiffness = 0.0;  ///< K_max [N/m], >= 0
  StiffnessLimit limit = StiffnessLimit::kHold;
};

/// The least of the bounds, and which it is. @param damping B.
[[nodiscard]] StiffnessBound stiffness_bound(const WallLoop& loop, double damping) noexcept;

/// One line that names the limit, for a stiffness above it; empty for others.
[[nodiscard]] std::string stiffness_warning(const WallLoop& loop, double stiffness, double damping);

/// One line for a stiffness that is held to what tuning a device found.
[[nodiscard]] std::string tuned_note(double asked, double most);

}  // namespace palpate
