#include "lab/hand/wall/wall_run.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "common/base/index.h"
#include "common/haptics/constraint/half_space.h"
#include "common/servo/hand_step.h"
#include "common/servo/wall_loop.h"

namespace palpate {
namespace {

struct Range {
  double lower, upper;
  [[nodiscard]] double width() const { return upper - lower; }
};

Range range_of(std::span<const double> x) {
  const auto [lowest, highest] = std::minmax_element(x.begin(), x.end());
  return {*lowest, *highest};
}

/// Rises through the middle; one counts only after x was in the lowest quarter of the range, so that noise
/// about the middle is no rise.
double rises_per_second(std::span<const double> x, const Range& range, double period) {
  const double middle = 0.5 * range.lower + 0.5 * range.upper, low = range.lower + 0.25 * range.width();
  double first = 0.0, last = 0.0;  // [periods]
  int rises = 0;
  bool was_low = false;
  for (std::size_t n = 1; n < x.size(); ++n) {
    was_low = was_low || x[n - 1] < low;
    if (!was_low || x[n] < middle) continue;
    was_low = false;
    last = static_cast<double>(n) - (x[n] - middle) / (x[n] - x[n - 1]);
    if (rises++ == 0) first = last;
  }
  return rises > 1 && last > first ? (rises - 1) / ((last - first) * period) : 0.0;
}

/// Swings narrower than this [m] are none: a few micrometres, and what an encoder's step hides of any motion.
double narrowest_swing(const DeviceProfile& device) { return 5e-6 + 1.5 * device.encoder_step; }

}  // namespace

Oscillation find_oscillation(std::span<const double> x, double period, double floor) {
  const std::size_t quarter = x.size() / 4;
  if (quarter < 2) return {};
  const std::span<const double> tail = x.last(quarter);
  const Range before = range_of(x.last(2 * quarter).first(quarter)), range = range_of(tail);
  return {.sustained = range.width() > floor && range.width() > (1.0 - kDecay) * before.width(),
          .amplitude = 0.5 * range.width(),
          .frequency = rises_per_second(tail, range, period)};
}

std::unique_ptr<ProxyChain> wall_chain(const WallCase& wall) {
  ChainSettings settings{.stiffness = wall.stiffness, .damping = wall.damping};
  settings.passivity.from_links = wall.controlled ? 1.0 : ChainStep::kMaxLinks + 1.0;
  settings.passivity.max_damping = 0.5 * wall.device.mass * wall.rate;
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::make_unique<HalfSpaceConstraint>(Vec3{0.0}, Vec3{-1.0, 0.0, 0.0}));
  return std::make_unique<ProxyChain>(std::move(links), settings);
}

WallRun run_wall(const WallCase& wall) {
  // Nothing but the device itself holds the force back, or theory would be compared with a slew limit.
  const DeviceLimits limits{.force_cap = wall.device.peak_force, .slew_cap = 1e12};
  HandStepper stepper(wall_chain(wall), limits);
  SimulatedArm arm(wall.device, wall.hand, 0.0, {-wall.gap, 0.0, 0.0});
  arm.push({wall.push, 0.0, 0.0});
  WallRun run;
  const double period = 1.0 / wall.rate;
  const auto ticks = as_size(std::llround(wall.seconds * wall.rate));
  std::vector<double> path;
  path.reserve(ticks);
  bool touched = false;
  for (std::size_t n = 0; n < ticks; ++n) {
    const double now = static_cast<double>(n) * period;
    arm.advance(now);
    HandInput input{.time = now, .present = true, .sample = {arm.time(), arm.encoders(), 0}};
    const HandStep step = stepper.step(input);
    arm.command(now, step.force);
    const double x = arm.position().x, force = std::abs(step.force.x);
    path.push_back(x);
    touched = touched || x > 0.0;
    run.deepest = std::max(run.deepest, x);
    if (touched) run.farthest = std::max(run.farthest, -x);
    run.force = std::max(run.force, force);
  }
  run.saturated = run.force >= wall.device.peak_force;
  run.swing = find_oscillation(path, period, narrowest_swing(wall.device));
  run.energy = arm.energy();
  return run;
}

WallLoop loop_of(const WallCase& wall) {
  WallLoop loop = wall_loop(wall.device, wall.rate);
  loop.device_stiffness = 0.0;
  return loop;
}

double largest_stable_stiffness(const WallCase& given) {
  constexpr double kFirstPart = 1.0 / 16.0, kGrowth = 1.5;
  constexpr int kHalvings = 6;
  WallCase wall = given;
  const auto swings = [&wall](double stiffness) {
    wall.stiffness = stiffness;
    return run_wall(wall).swing.sustained;
  };
  double stable = 0.0, stiffness = std::max(1.0, kFirstPart * stiffness_bound(loop_of(given), 0.0).stiffness);
  for (; stiffness < kStiffest && !swings(stiffness); stiffness *= kGrowth) stable = stiffness;
  if (stiffness >= kStiffest) return kStiffest;
  if (stable == 0.0) return 0.0;
  double unstable = stiffness;
  for (int n = 0; n < kHalvings; ++n) {
    const double middle = std::sqrt(stable * unstable);
    (swings(middle) ? unstable : stable) = middle;
  }
  return stable;
}

}  // namespace palpate
