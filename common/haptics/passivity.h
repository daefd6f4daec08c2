/// Time-domain passivity observer and controller (Hannaford & Ryu 2002): watches the energy that the hand
/// gets back, and damps the hand once that is more than it has put in.
///
/// Symbols. x_n position of the hand at step n, d_n = x_n - x_(n-1) [m], F_n force on the hand that was sent
/// at step n [N], f_n the force that the chain asks for, E_n energy that chain and arm have taken up [J], T_n
/// time since the step before [s], S_n the most that the springs can hold [J], b_0 damping of the arm [N
/// s/m].
///
///   observer     E_n = min(E_(n-1) - F_(n-1) . d_n + b_0 |d_n|^2 / T_n,  S_n)                       (1)
///   controller   alpha_n = -E_n T_n / |d_n|^2   where E_n < 0, else 0                               (2)
///                F_n = f_n - alpha_n d_n / T_n,   0 <= alpha_n <= alpha_max                         (3)
///
/// An actuator holds F_(n-1) until step n, so F . d is the exact work between two samples, in increments of
/// position; the product of force and velocity at the samples would hide the leak of the hold. F is what the
/// safety stage let through, not what was asked for. In (2) and (3) the hand moves on as it did.
///
/// Departures. What the springs cannot give back is no credit: that is the minimum in (1). The paper lets E
/// grow, and energy that was lost in drag long ago then pays for an oscillation now. b_0 is damping that
/// every arm has, 0.1 N s/m: up to K = 2 b_0 / T it takes what the hold leaks (coupling.h), so that a chain
/// of the default stiffness is left alone. A debt is forgotten once the hand has felt no force for
/// kForgetAfter; a hand slower than the dead speed is not damped. It is a second line behind the bound on the
/// stiffness, and no replacement: alpha is held a step long as well, and in a loop with delay it comes late.
#pragma once

#include "common/haptics/chain_settings.h"
#include "common/math/vec.h"

namespace palpate {

class PassivityController {
 public:
  static constexpr double kForgetAfter = 0.1;  ///< [s]

  /// Knows of no energy, and of no position.
  void reset() noexcept { *this = PassivityController{}; }

  /// Observes the step to `position`, and gives the force to be asked of the safety stage.
  /// @param force f [N].  @param stored S [J].  @param dt T [s], > 0. @pre all finite. @rt Safe.
  [[nodiscard]] Vec3 control(const Vec3& position, double dt, const Vec3& force, double stored,
                             const PassivitySettings& settings) noexcept;
  /// The force that is on the hand from now on. @param active the part of it that is meant to drive the hand,
  /// and is not held against the springs [N].
  void sent(const Vec3& force, const Vec3& active = Vec3{0.0}) noexcept { held_ = force - active; }

  [[nodiscard]] double energy() const noexcept { return energy_; }    ///< E [J]
  [[nodiscard]] double damping() const noexcept { return damping_; }  ///< alpha of the last step [N s/m]

 private:
  Vec3 last_{0.0};  ///< x_(n-1)
  Vec3 held_{0.0};  ///< F_(n-1)
  bool known_ = false;
  double energy_ = 0.0;
  double damping_ = 0.0;
  double idle_ = 0.0;  ///< [s] without a force
};

}  // namespace palpate
