#include "lab/hand/wall/energy_cycle.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "common/base/index.h"
#include "common/servo/hand_step.h"

namespace palpate {
namespace {

/// The path, at any time.
double place_at(double time, double before) {
  const double inside = kCycleSpeed * time - before;
  return inside < kCycleDepth ? inside : 2.0 * kCycleDepth - inside;
}

struct Held {
  double from = 0.0;  ///< [s]
  double force = 0.0;
};

/// Work of a force that changes at the times of `held`, along the path from `begin` to `end`. The path turns
/// at one time, and is straight before and after.
double work_along(const std::deque<Held>& held, double begin, double end, double before) {
  const double turn = (before + kCycleDepth) / kCycleSpeed;
  double work = 0.0;
  const auto add = [&](double force, double from, double to) {
    for (const auto& [a, b] : {std::pair{from, std::min(to, turn)}, std::pair{std::max(from, turn), to}}) {
      if (b > a) work += force * (place_at(b, before) - place_at(a, before));
    }
  };
  for (std::size_t n = 0; n < held.size(); ++n) {
    const double until = n + 1 < held.size() ? held[n + 1].from : end;
    add(held[n].force, std::max(begin, held[n].from), std::min(end, until));
  }
  return work;
}

}  // namespace

EnergyCycle run_energy_cycle(const WallCase& wall) {
  const DeviceProfile& device = wall.device;
  const DeviceLimits limits{.force_cap = 1e12, .slew_cap = 1e15};
  HandStepper stepper(wall_chain(wall), limits);
  const double period = 1.0 / wall.rate, delay = device.sensor_delay + device.actuator_delay;
  // Whole ticks outside, long enough for a velocity to be known, and for a late force to have gone.
  const double outside_ticks = 2.0 + std::ceil((delay + 2.0 * period) / period);
  const double before = kCycleSpeed * period * outside_ticks;
  const double end = 2.0 * (before + kCycleDepth) / kCycleSpeed;
  std::deque<Held> held;
  const auto ticks = as_size(std::llround(end * wall.rate));
  for (std::size_t n = 0; n <= ticks; ++n) {
    const double now = static_cast<double>(n) * period, x = place_at(now - device.sensor_delay, before);
    const double step = device.encoder_step;
    const double seen = step > 0.0 ? step * std::round(x / step) : x;
    const HandInput input{.time = now, .present = true, .sample = {now, {seen, 0.0, 0.0}, 0}};
    held.push_back({now + device.actuator_delay, stepper.step(input).force.x});
  }
  EnergyCycle cycle;
  cycle.leaked = work_along(held, 0.0, end, before);
  cycle.lost = 2.0 * kCycleDepth * (device.damping * kCycleSpeed + device.friction);
  cycle.to_hand = cycle.leaked - cycle.lost;
  return cycle;
}

double energy_free_stiffness(const WallCase& given) {
  WallCase wall = given;
  const auto gives = [&wall](double stiffness) {
    wall.stiffness = stiffness;
    return run_energy_cycle(wall).to_hand > 0.0;
  };
  double low = 1.0, high = kStiffest;
  if (gives(low)) return low;
  if (!gives(high)) return high;
  constexpr double kPrecision = 1e-6;
  while (high - low > kPrecision * low) {
    const double middle = std::sqrt(low * high);
    (gives(middle) ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace palpate
