/// One axis of a simulated arm in a simulated hand: a mass with a damper, a spring and dry friction.
///
///   m x'' + b x' + k (x - r) + f_c sgn(x') = F                                                       (1)
///
/// Symbols: m mass [kg], b damping [N s/m], k stiffness of the spring [N/m] to its rest r [m], f_c Coulomb
/// friction [N], F the force of motors and pushes [N]. While F and r are constant, and until x' changes its
/// sign, (1) is linear, and its solution over a time t is closed:
///
///   x(t) = x_0 + v_0 (h + (b/m) H) + a_0 H,   v(t) = v_0 (h' + (b/m) h) + a_0 h                      (2)
///
/// with a_0 = x''(0), h the impulse response (m h'' + b h' + k h = 0, h(0) = 0, h'(0) = 1) and H its
/// integral. h is summed from its power series, which serves over- and underdamped axes, k = 0 and b = 0
/// alike, and is exact to rounding for the short intervals that it is used on. So there is no step size: a
/// stability bench built on this sees the instability of the sampled loop, and none of an integrator.
///
/// At rest the mass sticks while |F - k (x - r)| <= f_c, and the instant at which it comes to rest is found
/// as the root of v(t). Stiction equals f_c: there is no extra break-away force.
#pragma once

namespace palpate {

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

}  // namespace palpate
