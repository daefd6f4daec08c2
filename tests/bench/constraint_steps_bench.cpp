// Many steps of every constraint on made hands, against closed forms, through the step that the servo takes:
//   constraint_steps_bench [STEPS [FIRST]]
// STEPS a constraint (1000000), hands numbered from FIRST (0). A hand goes along the feature, trembles, is pulled off and jumps;
// every 61st row is bad (NaN, infinity, time that stands). The run fails where a force or proxy is not finite,
// a bad row has a force, a force exceeds the cap, or a proxy that is held states more than 1e-6 m from its feature.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "common/haptics/proxy_chain.h"
#include "common/servo/hand_step.h"
#include "lab/hand/constraint/constraint_budget.h"

namespace palpate::test {
namespace {

constexpr double kPeriod = 1e-3;  // [s]
constexpr double kFar = 1e-6;     // [m] from the feature

struct Tally {
  std::size_t steps = 0, bad_rows = 0, not_finite = 0, forces_on_faults = 0, over_cap = 0, fell_back = 0;
  double residual =
      0.0;             ///< [m] largest distance of the proxy from its feature, as steps that hold it state it
  double force = 0.0;  ///< of the cap
};

/// A constraint's hand for some seconds, which ends before the guide leaves what it knows in closed form.
void run_hand(const BudgetSubject& subject, std::mt19937_64& random, std::size_t steps, Tally& tally) {
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(subject.make());
  ChainSettings settings = subject.settings;
  settings.stiffness = 1600.0;  // asks for more than the cap
  HandStepper stepper(std::make_unique<ProxyChain>(std::move(links), settings), DeviceLimits{});
  const double cap = stepper.limits().force_cap;
  std::normal_distribution<double> tremor(0.0, 2e-4);
  std::uniform_real_distribution<double> pull(-8e-3, 8e-3);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Vec3 off{0.0};
  (void)stepper.step({.time = -kPeriod});
  for (std::size_t n = 0; n < steps; ++n) {
    const auto time_of = [](std::size_t row) { return static_cast<double>(row) * kPeriod; };
    const double time = time_of(n);
    if (n % 97 == 0) off = {pull(random), pull(random), pull(random)};
    Vec3 x = subject.guide(time) + off + Vec3{tremor(random), tremor(random), tremor(random)};
    double at = time;
    const bool bad = n % 61 == 60;
    if (bad) {
      switch (n / 61 % 4) {
        case 0:
          x = Vec3{kNan};
          break;
        case 1:
          x.z = -HUGE_VAL;
          break;
        case 2:
          at = time_of(n - 1);
          break;
        default:
          at = kNan;
      }
    }
    HandInput hand{.time = at, .present = true};
    hand.sample = {at, x, 0};
    const HandStep step = stepper.step(hand);
    ++tally.steps;
    const double force = glm::length(step.force);
    const Vec3 proxy = step.chain.proxy(step.probe);
    if (!std::isfinite(force) || !is_finite(proxy)) ++tally.not_finite;
    if (bad) {
      ++tally.bad_rows;
      if (force != 0.0) ++tally.forces_on_faults;
      continue;
    }
    if (force > cap * (1.0 + 1e-12)) ++tally.over_cap;
    tally.force = std::max(tally.force, force / cap);
    if (step.state == HoldState::kFellBack) ++tally.fell_back;
    if (step.state == HoldState::kHeld) tally.residual = std::max(tally.residual, step.chain.residual);
  }
}

int run(int count, char** arguments) {
  const auto number = [&](int i, long otherwise) { return i < count ? std::atol(arguments[i]) : otherwise; };
  const auto steps = static_cast<std::size_t>(number(1, 1'000'000));
  const auto first = static_cast<std::uint64_t>(number(2, 0));
  constexpr std::size_t kHand = 5000;  // steps, after which another hand begins
  bool failed = false;
  for (const BudgetSubject& subject : budget_subjects()) {
    const auto begin = std::chrono::steady_clock::now();
    std::mt19937_64 random{first};
    Tally tally;
    while (tally.steps < steps) run_hand(subject, random, std::min(kHand, steps - tally.steps), tally);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    std::printf(
        "%-22s %8zu steps, %6zu of bad rows: not finite %zu, forces on bad rows %zu, over the cap %zu, fell back %zu, "
        "residual %.1e m, force %.3f of the cap, %.2f us a step\n",
        subject.name.c_str(), tally.steps, tally.bad_rows, tally.not_finite, tally.forces_on_faults,
        tally.over_cap, tally.fell_back, tally.residual, tally.force,
        1e6 * seconds / static_cast<double>(std::max<std::size_t>(1, tally.steps)));
    failed =
        failed || tally.not_finite + tally.forces_on_faults + tally.over_cap > 0 || tally.residual > kFar;
  }
  return failed ? 1 : 0;
}

}  // namespace
}  // namespace palpate::test

int main(int count, char** arguments) { return palpate::test::run(count, arguments); }
