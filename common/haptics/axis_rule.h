/// Rules along the axes of a frame, and how a proxy moves by all of them at once (Ikits 2006, sec. 6.3
/// to 6.5).
///
/// dx is the probe as seen from the last proxy, dp the motion of the proxy, r = dx - dp what is left between
/// them, all along the axes of the frame [m]. What a rule allows for r:
///
///   free        r_a = 0                      fixed       any r_a
///   drag        sum_a (r_a / tau_a)^2 <= 1, over all dragged axes at once (motion_rule.h)
///   unilateral  -tau_a <= r_a <= 0, with the axis pointing outward, into free space (eq. 6.7)
///   snap        as drag, and dp goes by whole detents (snap_jointly())
///
/// dp is the least motion that leaves an allowed r, so that r changes by no more than dx, but for the detents.
/// Where thresholds and axes change with the place, r changes by the change of what is allowed as well.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "common/math/vec.h"

namespace palpate {

enum class AxisRule : std::uint8_t { kFree, kDrag, kUnilateral, kSnap, kFixed };
inline constexpr int kAxisRuleCount = 5;
[[nodiscard]] std::string_view name_of(AxisRule rule) noexcept;  ///< "unilateral"
[[nodiscard]] std::optional<AxisRule> axis_rule_of(std::string_view name) noexcept;

/// The rule of an axis as it holds at one place.
struct AxisHold {
  AxisRule rule = AxisRule::kFree;
  double tau = 0.0;    ///< [m], >= 0; without meaning for free and fixed axes
  double kappa = 1.0;  ///< stiffness factor, in [0, 1]

  /// How far the probe can be from the proxy: 0 for free axes, infinite for fixed ones. One number for both
  /// ways; the free side of a unilateral axis makes it 0.
  [[nodiscard]] double reach() const noexcept {
    if (rule == AxisRule::kFixed) return std::numeric_limits<double>::infinity();
    return rule == AxisRule::kDrag || rule == AxisRule::kSnap ? tau : 0.0;
  }
};

using AxisHolds = std::array<AxisHold, 3>;

/// A motion of the proxy.
struct AxisMotion {
  Vec3 moved{0.0};     ///< dp
  Mat3 jacobian{0.0};  ///< d dp / d dx with thresholds held fixed, along the axes
};

/// dp. Thresholds of drag and snap axes grow by `friction` times what presses: the length of r over
/// unilateral and fixed axes (sec. 6.5: friction that grows with the penetration). @rt Safe.
[[nodiscard]] AxisMotion move_by_rules(const Vec3& dx, const AxisHolds& holds, double friction) noexcept;

/// Takes the difference out of axes `first` to 2, as far as `certainty` in [0, 1] falls below 1: at 0 they
/// all have the least reach and stiffness of them, or none where they snap and drag, so that nothing depends
/// on how they are turned; a fixed axis then is dragged. Continuous in `certainty`.
void make_alike(AxisHolds& holds, int first, double certainty) noexcept;

/// Lets all axes go as far as `certainty` falls below 1; at 0 they are free. Continuous in `certainty`.
void let_go(AxisHolds& holds, double certainty) noexcept;

}  // namespace palpate
