/// The energy that a sampled wall gives in one cycle: pressed in to a depth p and drawn back, at constant
/// speed v, by a hand that nothing disturbs.
///
/// Held over each period T, the force lags behind the spring's on the way in and exceeds it on the way out,
/// by K v T / 2 either way. Over the closed cycle the wall leaks K v T p, the arm's damping b takes 2 b v p,
/// and so does friction 2 f_c p. Without friction the hand gets energy back exactly when
///
///   K > 2 b / T                                                                                      (1)
///
/// the bound of Colgate & Schenkel 1994, as long as p is a whole number of v T.
#pragma once

#include "lab/hand/wall/wall_run.h"

namespace palpate {

struct EnergyCycle {
  double leaked = 0.0;   ///< work of the motors over the cycle [J]: what wall, hold and delay gave
  double lost = 0.0;     ///< in damping and friction of the arm [J]
  double to_hand = 0.0;  ///< leaked - lost
};

inline constexpr double kCycleSpeed = 0.05;   ///< v [m/s]
inline constexpr double kCycleDepth = 0.002;  ///< p [m], a whole number of v T for rates of 100 Hz and more

/// The cycle at the loop of `wall`, of which hand, push, gap and time say nothing. The path is begun outside
/// of the wall, and the wall's force has gone when it ends.
[[nodiscard]] EnergyCycle run_energy_cycle(const WallCase& wall);

/// The stiffness at which to_hand changes its sign [N/m], to 1e-6 of it: between 1 and kStiffest, or the one
/// of these bounds where it does not change.
[[nodiscard]] double energy_free_stiffness(const WallCase& wall);

}  // namespace palpate
