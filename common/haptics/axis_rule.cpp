#include "common/haptics/axis_rule.h"

#include <algorithm>
#include <cmath>

#include "common/base/index.h"
#include "common/haptics/motion_rule.h"

namespace palpate {
namespace {

constexpr std::array<std::string_view, kAxisRuleCount> kNames{"free", "drag", "unilateral", "snap", "fixed"};

/// Stretch at which a fixed axis gives when it is half certain [m]: 2 N on the default spring.
constexpr double kHalfReach = 0.010;

bool is_dragged(const AxisHold& hold) noexcept {
  return hold.rule == AxisRule::kDrag || hold.rule == AxisRule::kFixed || hold.rule == AxisRule::kFree;
}

/// Brings `hold` from `least` reach at certainty 0 to its own at 1.
void fade_reach(AxisHold& hold, double least, double certainty) noexcept {
  if (hold.rule == AxisRule::kFixed) {
    if (!(certainty < 1.0) || std::isinf(least)) return;
    hold.rule = AxisRule::kDrag;
    hold.tau = least + kHalfReach * certainty / (1.0 - certainty);
  } else {
    hold.tau = least + certainty * (hold.tau - least);
  }
}

}  // namespace

std::string_view name_of(AxisRule rule) noexcept { return kNames[as_size(rule)]; }

std::optional<AxisRule> axis_rule_of(std::string_view name) noexcept {
  const auto at = std::find(kNames.begin(), kNames.end(), name);
  if (at == kNames.end()) return std::nullopt;
  return static_cast<AxisRule>(at - kNames.begin());
}

AxisMotion move_by_rules(const Vec3& dx, const AxisHolds& holds, double friction) noexcept {
  AxisMotion motion;
  double pressed = 0.0;  // squared
  for (int a = 0; a < 3; ++a) {
    const AxisHold& hold = holds[as_size(a)];
    if (hold.rule == AxisRule::kUnilateral) {
      motion.moved[a] = unilateral(dx[a], hold.tau);
      const bool moves = dx[a] > 0.0 || dx[a] < -hold.tau;
      motion.jacobian[a][a] = moves ? 1.0 : 0.0;
    }
    if (hold.rule == AxisRule::kUnilateral || hold.rule == AxisRule::kFixed) {
      const double left = dx[a] - motion.moved[a];
      pressed += left * left;
    }
  }
  const double more = friction > 0.0 ? friction * std::sqrt(pressed) : 0.0;
  // Axes that have no part in a joint rule are fixed to it, and it to them.
  Vec3 drags{HUGE_VAL}, snaps{HUGE_VAL};
  bool any_drag = false, any_snap = false;
  for (int a = 0; a < 3; ++a) {
    const AxisHold& hold = holds[as_size(a)];
    if (hold.rule == AxisRule::kFree) drags[a] = 0.0;
    if (hold.rule == AxisRule::kDrag) drags[a] = hold.tau + more;
    if (hold.rule == AxisRule::kSnap) snaps[a] = hold.tau + more;
    any_drag = any_drag || drags[a] < HUGE_VAL;
    any_snap = any_snap || snaps[a] < HUGE_VAL;
  }
  if (any_drag) {
    const JointDrag drag = drag_jointly(dx, drags);
    motion.moved += drag.moved;
    motion.jacobian += drag.jacobian;
  }
  if (any_snap) {
    motion.moved += snap_jointly(dx, snaps);
    for (int a = 0; a < 3; ++a) motion.jacobian[a][a] += snaps[a] > 0.0 ? 0.0 : 1.0;
  }
  return motion;
}

void make_alike(AxisHolds& holds, int first, double certainty) noexcept {
  if (!(certainty < 1.0)) return;
  double reach = HUGE_VAL, kappa = 1.0;
  bool all_drag = true, all_snap = true;
  for (int a = first; a < 3; ++a) {
    const AxisHold& hold = holds[as_size(a)];
    reach = std::min(reach, hold.reach());
    kappa = std::min(kappa, hold.kappa);
    all_drag = all_drag && is_dragged(hold);
    all_snap = all_snap && hold.rule == AxisRule::kSnap;
  }
  if (!all_drag && !all_snap) reach = 0.0;
  for (int a = first; a < 3; ++a) {
    AxisHold& hold = holds[as_size(a)];
    fade_reach(hold, reach, certainty);
    hold.kappa = kappa + certainty * (hold.kappa - kappa);
  }
}

void let_go(AxisHolds& holds, double certainty) noexcept {
  for (AxisHold& hold : holds) fade_reach(hold, 0.0, certainty);
}

}  // namespace palpate
