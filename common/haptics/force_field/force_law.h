/// Forces as functions of the data at the probe and of the hand's velocity (Ikits 2006, sec. 2.3.2).
///
///   density drag          f = -b h(r) xdot,   r = (s - s_min) / (s_max - s_min)            (2.3)
///   direct display        f = F v / v_max                                                  (2.4)
///   vortex pull           f = F w / max(1, |w|),   w = (omega x v) / W                     (2.5)
///   transverse damping    f = -b g(|v|) (xdot - (xdot . t) t),   t = v / |v|               (2.6)
///
/// with the strength F [N] and the damping b [N s/m] of the hand, h a haptic transfer function, and v, omega
/// and s over scales of their field: a mode feels the same on a cell and on a galaxy. Eq. 2.5 points to the
/// core of a helix. Eq. 2.6 is printed without its sign, with which it would push the hand on, and jumps
/// where v vanishes and t has no meaning: g fades it there.
///
/// Drags are given as coefficients b_a >= 0 along the axes e_a of a frame (LinkUpdate::damping), which makes
/// it plain that they only take energy from the hand.
#pragma once

#include "common/math/vec.h"

namespace palpate {

/// The scales of a vector field by which forces are made free of its units.
struct FlowScale {
  double speed = 0.0;      ///< v_max, data units; 0: there is no force
  double vorticity = 0.0;  ///< unit of omega, data units [1 / time]
  double lamb = 0.0;       ///< W in units of both: |omega x v| of a strong vortex; 0: there is none
};

/// A drag  f = -sum_a b_a e_a e_a^T xdot.
struct AxisDrag {
  Mat3 frame{1.0};    ///< columns e_a
  Vec3 damping{0.0};  ///< b_a [N s/m], >= 0
};

/// r in [0, 1]; 0 where the values do not differ.
[[nodiscard]] double density_part(double value, double lowest, double highest) noexcept;

/// Eq. 2.4 [N].
[[nodiscard]] Vec3 direct_force(const Vec3& v, const FlowScale& scale, double strength) noexcept;

/// (omega x v) in units of speed and vorticity.
[[nodiscard]] Vec3 lamb_vector(const Vec3& omega, const Vec3& v, const FlowScale& scale) noexcept;
/// Eq. 2.5 [N], no more than |strength|.
[[nodiscard]] Vec3 vortex_force(const Vec3& omega, const Vec3& v, const FlowScale& scale,
                                double strength) noexcept;

/// Eq. 2.6.
/// @param fade_speed part of scale.speed below which it fades: g rises smoothly from 0 to 1 there.
[[nodiscard]] AxisDrag transverse_drag(const Vec3& v, const FlowScale& scale, double damping,
                                       double fade_speed) noexcept;

}  // namespace palpate
