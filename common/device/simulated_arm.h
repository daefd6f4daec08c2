/// A simulated arm in a simulated hand: three axes (simulated_arm.h) with encoders and motors.
///
/// Each axis moves by itself and has its own friction, as the motors of a real arm do, whose axes are taken
/// to be those of the workspace. A command takes effect after the actuators' delay, is held until the next
/// one does (zero-order hold), and is shortened to the peak force. Encoders round to their step.
///
/// The sensors' delay needs no memory: the arm is simulated up to the instant that the sensors show, which
/// lies that delay in the past, and commands given now take effect both delays later. A loop sees their sum.
///
/// What becomes of energy is kept to rounding, per axis with a constant force in each interval:
///
///   motors + pushes + hand = viscous + friction + kinetic + stored                                  (1)
#pragma once

#include <array>
#include <cstddef>

#include "common/device/device_profile.h"
#include "common/device/hand_model.h"
#include "common/math/vec.h"

namespace palpate {

// One axis of a simulated arm in a simulated hand: a mass with a damper, a spring and dry friction.
//
//   m x'' + b x' + k (x - r) + f_c sgn(x') = F                                                       (1)
//
// Symbols: m mass [kg], b damping [N s/m], k stiffness of the spring [N/m] to its rest r [m], f_c Coulomb
// friction [N], F the force of motors and pushes [N]. While F and r are constant, and until x' changes its
// sign, (1) is linear, and its solution over a time t is closed:
//
//   x(t) = x_0 + v_0 (h + (b/m) H) + a_0 H,   v(t) = v_0 (h' + (b/m) h) + a_0 h                      (2)
//
// with a_0 = x''(0), h the impulse response (m h'' + b h' + k h = 0, h(0) = 0, h'(0) = 1) and H its
// integral. h is summed from its power series, which serves over- and underdamped axes, k = 0 and b = 0
// alike, and is exact to rounding for the short intervals that it is used on. So there is no step size: a
// stability bench built on this sees the instability of the sampled loop, and none of an integrator.
//
// At rest the mass sticks while |F - k (x - r)| <= f_c, and the instant at which it comes to rest is found
// as the root of v(t). Stiction equals f_c: there is no extra break-away force.

/// What moves: the arm, and what of the hand moves with it. All finite and >= 0, the mass above zero.
struct AxisLoad {
  double mass = 0.1;       ///< m [kg]
  double damping = 0.0;    ///< b [N s/m]
  double stiffness = 0.0;  ///< k [N/m]
  double friction = 0.0;   ///< f_c [N]

  bool operator==(const AxisLoad&) const = default;
};

struct AxisState {
  double position = 0.0;  ///< [m]
  double velocity = 0.0;  ///< [m/s]

  bool operator==(const AxisState&) const = default;
};

/// What became of the work of F over an advance, apart from motion and spring [J]. Both >= 0 but for
/// rounding.
struct AxisLoss {
  double viscous = 0.0;   ///< in the damper: the integral of b x'^2
  double friction = 0.0;  ///< the integral of f_c |x'|
};

/// 1/2 m x'^2 + 1/2 k (x - r)^2 [J].
[[nodiscard]] double axis_energy(const AxisLoad& load, const AxisState& state, double rest) noexcept;

/// Moves `state` by the time dt [s] under a constant force F [N] and rest r [m].
/// @pre all finite, dt >= 0. @rt Safe for dt far below m/b and sqrt(m/k): the work grows in proportion to dt
/// over the shorter of them.
AxisLoss advance_axis(const AxisLoad& load, double force, double rest, double dt, AxisState& state) noexcept;

/// What the parts of (1) have come to since the start [J].
struct ArmEnergy {
  double motors = 0.0;    ///< work of the motors on the arm: what the virtual environment gave
  double pushes = 0.0;    ///< work of push()
  double hand = 0.0;      ///< put into the hand's spring by moving its rest
  double viscous = 0.0;   ///< lost in the dampers of arm and hand
  double friction = 0.0;  ///< lost to friction

  bool operator==(const ArmEnergy&) const = default;
};

class SimulatedArm {
 public:
  static constexpr std::size_t kMostPending = 512;  ///< commands under way: 50 ms at 10 kHz
  static constexpr double kLongestGap = 0.1;        ///< [s] after a longer pause the arm has stood meanwhile

  /// At rest at `position` [m], where the hand holds it. @pre profile.valid().
  SimulatedArm(const DeviceProfile& profile, const HandImpedance& hand, double time, const Vec3& position);

  /// The force [N] of the motors from time + actuators' delay on. `time` does not fall. @rt Safe.
  void command(double time, const Vec3& force) noexcept;
  /// No force from the motors from this instant on, whatever is under way. @rt Safe.
  void stop() noexcept;
  /// Where the hand wants to be from now on [m].
  void set_rest(const Vec3& rest) noexcept;
  /// A constant force on the arm from now on [N].
  void push(const Vec3& force) noexcept { push_ = force; }
  /// Moves the arm to what the sensors show at `time`. @rt Safe.
  void advance(double time) noexcept;

  /// The instant that the arm is at [s]: that of the last advance() less the sensors' delay.
  [[nodiscard]] double time() const noexcept { return time_; }
  /// What the encoders show [m].
  [[nodiscard]] Vec3 encoders() const noexcept;
  [[nodiscard]] Vec3 position() const noexcept;  ///< the true one [m]
  [[nodiscard]] Vec3 velocity() const noexcept;  ///< [m/s]
  /// In force [N]. Tests hold the motors to command(), by this.
  [[nodiscard]] const Vec3& motor_force() const noexcept { return motor_; }
  [[nodiscard]] const DeviceProfile& profile() const noexcept { return profile_; }

  [[nodiscard]] const ArmEnergy& energy() const noexcept { return energy_; }
  [[nodiscard]] double stored() const noexcept;  ///< in the hand's spring [J]; tests hold (1) with it

 private:
  struct Pending {
    double time = 0.0;
    Vec3 force{0.0};
  };

  void move(double dt) noexcept;

  DeviceProfile profile_;
  AxisLoad load_;
  double time_;
  std::array<AxisState, 3> axes_{};
  Vec3 rest_, motor_{0.0}, push_{0.0};
  std::array<Pending, kMostPending> pending_{};
  std::size_t first_pending_ = 0;
  std::size_t pending_count_ = 0;
  ArmEnergy energy_;
};

}  // namespace palpate
