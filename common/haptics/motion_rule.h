/// Motion rules (Ikits 2006, sec. 6.4): how far a proxy moves when its probe is displaced from it.
///
/// All of them answer with a displacement of the proxy. dx is that of the probe from the last proxy; tau >= 0
/// is the drag threshold. An infinite tau fixes the proxy, tau = 0 lets it go freely.
#pragma once

#include "common/math/vec.h"

namespace palpate {

/// Drag (eq. 6.5): follows at a distance of tau.
[[nodiscard]] double drag(double dx, double tau) noexcept;

/// Unilateral drag (eq. 6.7): `outward` (positive) motion is free, into the surface it drags at tau.
[[nodiscard]] double unilateral(double dx_outward, double tau) noexcept;

/// Snap-drag: stays until the probe is farther than tau, then jumps in steps of tau to within tau of it.
/// Eq. 6.8 jumps once, and so falls behind a fast probe; both agree below 2 tau.
[[nodiscard]] double snap_drag(double dx, double tau) noexcept;

/// What drag along several axes does.
struct JointDrag {
  Vec3 moved{0.0};       ///< dp
  Mat3 jacobian{0.0};    ///< d dp / d dx, symmetric
  int newton_steps = 0;  ///< that it took, <= kMaxNewtonSteps
};

/// Newton's method is stopped there. It has come to rest before, unless one threshold is more than some 1e10
/// times another and the probe stands at its end: then what is left has come to within 1e-8 of the ellipsoid.
inline constexpr int kMaxNewtonSteps = 24;

/// Drag along several axes at once: the proxy moves the least distance by which the probe comes to lie in
/// the ellipsoid sum_a ((dx_a - dp_a) / tau_a)^2 <= 1. On one axis this is eq. 6.5; eqs. 6.2 to 6.5 taken
/// axis by axis would hold the probe in a box, whose hold depends on how an arbitrary frame is turned.
///
///   r_a = dx_a - dp_a = dx_a tau_a^2 / (tau_a^2 + m),   m >= 0
///   d dp_a / d dx_b = delta_ab m / (tau_a^2 + m) + v_a v_b / S
///   v_a = r_a / (tau_a^2 + m),   S = sum_a (r_a / tau_a)^2 / (tau_a^2 + m)
///
/// The derivative is 0 along axes on which the proxy stays, 1 along free ones. With equal thresholds it is
/// 1 - (tau / |dx|) (1 - n n^T), n the direction of dx.
[[nodiscard]] JointDrag drag_jointly(const Vec3& dx, const Vec3& tau) noexcept;

/// Snap-drag along several axes at once: stays while the probe is within the ellipsoid of drag_jointly(),
/// then jumps towards it by whole detents, to within the ellipsoid. On one axis this is snap_drag(); infinite
/// tau fixes an axis, tau = 0 lets it go freely.
[[nodiscard]] Vec3 snap_jointly(const Vec3& dx, const Vec3& tau) noexcept;

}  // namespace palpate
