#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/servo/hand_step.h"
#include "lab/extremes/extreme.h"
#include "lab/hand/wall/wall_extremes.h"

namespace palpate {
namespace {

constexpr int kSteps = 4000;

/// Holds the hand to the origin.
class Anchor final : public Constraint {
 public:
  void apply(const ChainSettings& /*settings*/) noexcept override {}
  void reset() noexcept override {}
  void update(const Vec3& /*probe*/, const UpdateBudget& /*budget*/, LinkUpdate& link) noexcept override {
    link.proxy = Vec3{0.0};
    link.jacobian = Mat3{0.0};
    link.state = HoldState::kHeld;
  }
};

/// A hand that circles the origin at 2 cm once a second, with a device that does something to it.
struct DeviceCase {
  std::function<void(int step, HandInput& input)> spoil;
  DeviceLimits limits;
  double stiffness = 1000.0;
  /// Whether there may be no force at all in this step.
  std::function<bool(int step)> dead = [](int) { return false; };
};

/// Worst of: force over the cap; growth or turn over the slew limit; infinite for a force that is no number, that stands where
/// there may be none, or that is never there.
double worst_force(const DeviceCase& of) {
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::make_unique<Anchor>());
  ChainSettings settings;
  settings.stiffness = of.stiffness;
  HandStepper stepper(std::make_unique<ProxyChain>(std::move(links), settings), of.limits);
  Vec3 last{0.0};
  double last_time = kNaN, worst = 0.0, most = 0.0;
  for (int n = 0; n < kSteps; ++n) {
    const double t = 1e-3 * n, angle = 6.283185307179586 * t;
    HandInput input{t, true, {t, 0.02 * Vec3{std::cos(angle), std::sin(angle), 0.0}, 0}};
    of.spoil(n, input);
    const HandStep step = stepper.step(input);
    const double dt = input.time - last_time;
    if (std::isfinite(input.time)) last_time = input.time;
    if (!is_finite(step.force) || (of.dead(n) && step.force != Vec3{0.0})) return HUGE_VAL;
    const double length = glm::length(step.force), square = glm::dot(last, last);
    const double lambda = square > 0.0 ? std::clamp(glm::dot(step.force, last) / square, 0.0, 1.0) : 0.0;
    const double grown = glm::distance(step.force, lambda * last) - 4e-15 * of.limits.force_cap;
    const double may = dt > 0.0 ? of.limits.slew_cap * std::min(dt, SafetyStage::kLongestStep) : 0.0;
    worst = std::max(worst, length / of.limits.force_cap);
    if (grown > 0.0) worst = std::max(worst, may > 0.0 ? grown / may : HUGE_VAL);
    most = std::max(most, length);
    last = step.force;
  }
  return most > 0.0 ? worst : HUGE_VAL;
}

bool every(int step, int count) { return step % count == count - 1; }

}  // namespace

void add_wall_rows(std::vector<Extreme>& rows) {
  for (const WallExtreme& wall : wall_extremes()) {
    rows.push_back({ExtremeKind::kWall, wall.name, wall.builder, wall.claim, wall.limit, "mm",
                    [measure = wall.measure] { return measure(true); }, wall.guard,
                    [measure = wall.measure] { return measure(false); }});
  }
}

void add_device_rows(std::vector<Extreme>& rows) {
  const auto add = [&](const std::string& name, const std::string& builder, DeviceCase of) {
    rows.push_back({ExtremeKind::kDevice, name, builder,
                    "largest force and change of force, of their limits; none on a fault", 1.0 + 1e-9,
                    "of the limit", [of = std::move(of)] { return worst_force(of); }});
  };
  const auto on = [](int count) { return [count](int step) { return every(step, count); }; };
  add("firm hold", "a spring of 1000 N/m, five times the cap", {.spoil = [](int, HandInput&) {}});
  add("stiff beyond reason", "a spring of 1e9 N/m", {.spoil = [](int, HandInput&) {}, .stiffness = 1e9});
  add("NaN place", "a coordinate of every 61st sample",
      {.spoil =
           [](int n, HandInput& in) {
             if (every(n, 61)) in.sample.position.y = kNaN;
           },
       .dead = on(61)});
  add("infinite place", "a coordinate of every 61st sample",
      {.spoil =
           [](int n, HandInput& in) {
             if (every(n, 61)) in.sample.position.z = -HUGE_VAL;
           },
       .dead = on(61)});
  add("place of 1e300 m", "every 61st sample", {.spoil = [](int n, HandInput& in) {
        if (every(n, 61)) in.sample.position *= 1e302;
      }});
  add("time stands still", "every 61st step",
      {.spoil =
           [](int n, HandInput& in) {
             if (every(n, 61)) in.time = 1e-3 * (n - 1);
           },
       .dead = on(61)});
  add("time runs backwards", "by a second, every 61st step",
      {.spoil =
           [](int n, HandInput& in) {
             if (every(n, 61)) in.time -= 1.0;
           },
       .dead = on(61)});
  add("time is NaN", "every 61st step",
      {.spoil =
           [](int n, HandInput& in) {
             if (every(n, 61)) in.time = kNaN;
           },
       .dead = on(61)});
  add("stalls", "half a second, every 500 steps", {.spoil = [](int n, HandInput& in) {
        in.time += 0.5 * (n / 500);
        in.sample.time = in.time;
      }});
  add("vanishes", "for 50 of every 500 steps",
      {.spoil = [](int n, HandInput& in) { in.present = n % 500 < 450; },
       .dead = [](int n) { return n % 500 >= 450; }});
  add("lies about its place", "jumps by a metre, every 97th sample", {.spoil = [](int n, HandInput& in) {
        if (every(n, 97)) in.sample.position.x += 1.0;
      }});
  add("freezes", "the same sample for 300 of every 1000 steps; no force 0.2 s later",
      {.spoil =
           [](int n, HandInput& in) {
             if (n % 1000 < 700) return;
             const double t = 1e-3 * (n - n % 1000 + 699), angle = 6.283185307179586 * t;
             in.sample = {t, 0.02 * Vec3{std::cos(angle), std::sin(angle), 0.0}, 0};
           },
       .dead = [](int n) { return n % 1000 > 900; }});
  DeviceLimits gated;
  gated.velocity_gate = 1.0;
  gated.latch_faults = true;
  add("flies off", "5 m/s from step 2000 on, past the velocity gate: no force from then on",
      {.spoil =
           [](int n, HandInput& in) {
             if (n >= 2000) in.sample.position.x += 5e-3 * (n - 2000);
           },
       .limits = gated,
       .dead = [](int n) { return n > 2100; }});
  DeviceLimits held;
  held.enabling_button = 0;
  add("lets the button go", "an enabling button, held for 300 of every 500 steps",
      {.spoil = [](int n, HandInput& in) { in.sample.buttons = n % 500 < 300 ? 1U : ~1U; },
       .limits = held,
       .dead = [](int n) { return n % 500 > 400; }});
  DeviceLimits bounded;
  bounded.reach_lower = Vec3{-0.015, -0.1, -0.1};
  bounded.reach_upper = Vec3{0.1};
  add("leaves its reach", "a quarter of the circle is outside",
      {.spoil = [](int, HandInput&) {},
       .limits = bounded,
       .dead = [](int n) { return std::cos(6.283185307179586 * 1e-3 * n) < -0.76; }});
  DeviceLimits faint;
  faint.force_cap = 1e-3;
  faint.slew_cap = 1e6;
  add("cap of a millinewton", "with a slew limit of 1e6 N/s",
      {.spoil = [](int, HandInput&) {}, .limits = faint});
  add("jitters", "0.1 mm of noise, alternating",
      {.spoil = [](int n, HandInput& in) { in.sample.position.x += n % 2 == 0 ? 1e-4 : -1e-4; }});
  add("comes late", "every sample 90 ms old", {.spoil = [](int, HandInput& in) { in.sample.time -= 0.09; }});
}

}  // namespace palpate
