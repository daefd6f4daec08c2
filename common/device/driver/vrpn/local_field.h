/// A force near the hand as a model that can be evaluated elsewhere: what is felt is found out from the
/// forces that were asked for, and where, so that the loop of a device far away is closed there and not over
/// a network.
///
/// Symbols: x_n where the hand was [m], f_n the force that was asked for there [N], J stiffness [N/m].
///
///   F(p) = f_n + J (p - x_n)  for |p - x_n| < r,  else 0                                               (1)
///   J <- J + (q s^T + s q^T) / s^T s - (s^T q) s s^T / (s^T s)^2,  s = x_n - x_(n-1),
///                                                     q = f_n - f_(n-1) - J s                          (2)
///
/// (2) is Powell's symmetric form of Broyden's update (Powell 1970; Dennis and Schnabel 1983, sec. 9.2): the
/// least change of J that explains the last step. J is then brought to -k <= J <= 0 through its eigenvalues:
/// a spring that is passive whatever the hand does, no stiffer than k. Nothing of (1) is longer than the cap
/// C: |f_n| <= C, and J is made smaller until |f_n| + |J| r <= C.
#pragma once

#include "common/math/vec.h"

namespace palpate {

class LocalField {
 public:
  static constexpr double kLeastMove = 5e-5;  ///< [m] a shorter step tells nothing of the stiffness

  struct Model {
    Vec3 origin{0.0};     ///< x_n
    Vec3 force{0.0};      ///< f_n
    Mat3 stiffness{0.0};  ///< J, symmetric
    double radius = 0.0;  ///< r
  };

  /// @pre cap, stiffest and radius above zero, finite.
  LocalField(double cap, double stiffest, double radius) noexcept
      : cap_(cap), stiffest_(stiffest), radius_(radius) {}

  /// The force `force` was asked for at `x`. What is no number is no force. @rt Safe.
  void add(const Vec3& x, const Vec3& force) noexcept;
  /// Of the last add(); no force at all after reset(). @rt Safe.
  [[nodiscard]] Model model() const noexcept;
  void reset() noexcept;

 private:
  double cap_, stiffest_, radius_;
  bool any_ = false;
  Vec3 x_{0.0}, force_{0.0};                  ///< of the last add()
  Vec3 learned_x_{0.0}, learned_force_{0.0};  ///< of the last that J was learned from
  Mat3 stiffness_{0.0};
};

}  // namespace palpate
