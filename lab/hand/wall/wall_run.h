/// A simulated arm pushed against a virtual wall, through the very step that the servo takes.
///
/// The wall is the half space x > 0, a spring of stiffness K; the arm starts at rest outside of it, and is
/// pushed in by a constant force, with or without a hand that holds it. All of it is in simulated time, and
/// the arm's motion is exact (device/simulated_arm.h), so what swings does so because of the loop.
///
/// Theory. Pushed, the arm rests at F/K inside the wall, where the wall is two-sided for small motions. Held
/// over each period T, its force is late by T/2 on average, which takes K T/2 off the arm's damping b. With
/// a = e^(-e), e = b T/m, the sampled loop m x'' + b x' = -K x_n is stable for
///
///   K < (b^2/m) (1 - a) / (1 - a - a e) = (2 b/T) (1 + e/6 + O(e^2))                                (1)
///
/// So an unheld arm that is light in damping (e << 1) begins to swing at the very bound of passivity, 2 b/T
/// (Colgate & Schenkel 1994), which holds for any hand whatever. What swings leaves the wall once it swings
/// wider than F/K, and settles to a limit cycle.
#pragma once

#include <memory>
#include <span>

#include "common/device/device_profile.h"
#include "common/device/hand_model.h"
#include "common/device/simulated_arm.h"
#include "common/haptics/coupling.h"
#include "common/haptics/proxy_chain.h"

namespace palpate {

struct Oscillation {
  bool sustained = false;  ///< it does not die out
  double amplitude = 0.0;  ///< half of the way from lowest to highest, over the last quarter; unit of x
  double frequency = 0.0;  ///< [Hz] of rises through the middle of that way; 0 where there are fewer than two
};

/// Looks at the last half of evenly spaced samples. An oscillation is sustained where the range of the last
/// quarter is larger than `floor`, and has not fallen by kDecay from that of the quarter before: one that
/// grows, and one that has settled to a limit cycle, but not one that dies out by more than that.
inline constexpr double kDecay = 0.05;
/// @param period [s] between samples.  @param floor unit of x; below it nothing is called a swing.
[[nodiscard]] Oscillation find_oscillation(std::span<const double> x, double period, double floor);

struct WallCase {
  DeviceProfile device;
  HandImpedance hand = kUnheld;
  double stiffness = 1000.0;  ///< K [N/m]
  double damping = 0.0;       ///< of the coupling [N s/m]
  double rate = 1000.0;       ///< of the servo [Hz]
  double push = 1.0;          ///< [N] into the wall
  double gap = 0.0;           ///< [m] from where the arm starts to the wall
  double seconds = 4.0;       ///< simulated
  bool controlled = false;    ///< with the passivity controller
};

struct WallRun {
  double deepest = 0.0;    ///< largest x [m]
  double farthest = 0.0;   ///< largest -x after the first contact [m]: how far it was thrown out
  double force = 0.0;      ///< largest [N]
  bool saturated = false;  ///< the force reached the device's peak
  Oscillation swing;       ///< of x [m]
  ArmEnergy energy;        ///< at the end
};

[[nodiscard]] WallRun run_wall(const WallCase& wall);

/// What coupling.h needs to know of a case, but for the stiffness that its maker allows.
[[nodiscard]] WallLoop loop_of(const WallCase& wall);

/// The stiffness above which the arm first goes on swinging, to 1 % [N/m]; 0 where it always does. Tried from
/// a sixteenth of the theoretical bound on, by half as much more each time, then by halving the step in which
/// it happens. At most kStiffest.
inline constexpr double kStiffest = 1e6;
[[nodiscard]] double largest_stable_stiffness(const WallCase& wall);

/// A chain that is this wall and nothing else, controlled or not.
[[nodiscard]] std::unique_ptr<ProxyChain> wall_chain(const WallCase& wall);

}  // namespace palpate
