// The servo's steps over a real link in simulated time, for long: hands at borders, stalls, jitter, unplugged and failing
// devices, switches let go, links that are made anew. PALPATE_SOAK_SECONDS says how long [s of simulated time, 1000 steps each].

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/device/driver/dhd/dhd_link.h"
#include "common/haptics/proxy_chain.h"
#include "common/servo/hand_step.h"
#include "common/servo/linked_device.h"
#include "tests/common/device/driver/dhd/tether.h"
#include "tests/common/device/driver/fake_dhd.h"
#include "tests/common/device/driver/moved_clock.h"
#include "tests/common/device/driver/soak.h"
#include "tests/support/project_folders.h"

namespace palpate::test {
namespace {

constexpr double kCap = 3.0, kSlew = 50.0;  // [N], [N/s]
constexpr double kReach = 0.02;             // [m]

/// A servo that is stepped whenever its link asks for a force: not when it stalls, and late when it jitters. What it said
/// before holds for as long as to LinkedDevice.
class SteppedServo final : public ForceSource {
 public:
  SteppedServo(DriverLink& link, const MovedClock& clock, const DeviceLimits& limits, Soak& soak)
      : link_(link), clock_(clock), soak_(soak), stepper_(chain(), limits) {}

  Vec3 newest() noexcept override {
    const double now = clock_.now();
    if (now >= stalled_until_ && now >= next_) step(now);
    return now - told_at_ <= LinkedDevice::kFreshFor ? force_ : Vec3{0.0};
  }
  void stall(double until) { stalled_until_ = until; }
  [[nodiscard]] HandStepper& stepper() { return stepper_; }

  std::uint64_t steps = 0, crossings = 0, pulls = 0, faults = 0;
  bool forced_outside = false;  ///< a promise was broken

 private:
  static std::unique_ptr<ProxyChain> chain() {
    std::vector<std::unique_ptr<Constraint>> links;
    links.push_back(std::make_unique<Tether>());
    return std::make_unique<ProxyChain>(std::move(links), ChainSettings{.stiffness = 2000.0});
  }
  void step(double now) noexcept {
    const DeviceAtoms& atoms = link_.atoms();
    HandInput input{.time = now};
    input.present = atoms.has_position && now - atoms.time <= LinkedDevice::kKept;
    input.sample = {atoms.time, atoms.position, atoms.buttons};
    const HandStep made = stepper_.step(input);
    const bool is_outside = made.cut == ForceCut::kOutOfReach;
    const Vec3 most = glm::abs(atoms.position);
    if (std::max({most.x, most.y, most.z}) > kReach && made.force != Vec3{0.0}) forced_outside = true;
    crossings += is_outside != outside_ ? 1U : 0U;
    outside_ = is_outside;
    pulls += glm::length(made.force) > 1.0 ? 1U : 0U;
    faults += is_fault(made.cut) ? 1U : 0U;
    ++steps;
    force_ = made.force;
    told_at_ = now;
    next_ = soak_.chance(0.1) ? now + 0.004 * soak_.part() : now;
  }

  DriverLink& link_;
  const MovedClock& clock_;
  Soak& soak_;
  HandStepper stepper_;
  Vec3 force_{0.0};
  double told_at_ = -1.0, next_ = 0.0, stalled_until_ = 0.0;
  bool outside_ = false;
};

TEST(ServoOverALink, KeepsEveryPromiseForLong) {
  const double seconds = soak_seconds(600.0);
  const std::string file = (build_folder() / "tests" / "libpalpate_fake_dhd.so").string();
  const DhdFunctions functions = open_dhd_library(file);
  FakeDhd& fake = *fake_dhd_of(file);
  MovedClock clock;
  fake = FakeDhd();
  fake.wanders = false;
  fake.now = [&clock] { return clock.now(); };
  fake.wire = ForceWitness(kSlew);

  DhdSettings settings;
  settings.arm.reach = kReach;
  settings.arm.enabling_button = 0;
  DeviceLimits limits = settings.arm.limits();
  limits.force_cap = kCap;
  limits.slew_cap = kSlew;
  limits.start_ramp = 0.05;
  limits.edge_stiffness = 0.0;
  limits.enabling_button = 0;

  Soak soak(33);
  std::uint64_t steps = 0, crossings = 0, pulls = 0, faults = 0, links = 0;
  while (clock.now() < seconds && !::testing::Test::HasFailure()) {
    // Another program each time.
    auto link = std::make_unique<DhdLink>(functions, clock, settings);
    link->restrain(limits);
    SteppedServo servo(*link, clock, limits, soak);
    link->obey(&servo);
    ++links;
    double released_at = clock.now();
    for (const double until = clock.now() + 60.0; clock.now() < until && clock.now() < seconds;) {
      if (soak.chance(0.1)) fake.failing_calls = static_cast<int>(soak.below(20));
      if (soak.chance(0.1)) fake.repeated_calls = static_cast<int>(soak.below(50));
      if (soak.chance(0.05)) fake.switch_force_off(static_cast<int>(1 + soak.below(6)));
      if (soak.chance(0.05)) fake.arm.put(soak.within(0.16));
      if (soak.chance(0.02)) fake.throwing_calls = static_cast<int>(soak.below(4));
      fake.nonsense = soak.chance(0.02);
      fake.broken = soak.chance(0.02);
      fake.powered = !soak.chance(0.02);
      fake.plugged = !soak.chance(0.04);
      fake.arm.set_target(soak.within(0.10));
      const bool held = !soak.chance(0.1);
      if (!held && fake.buttons != 0U) released_at = clock.now();
      fake.buttons = held ? 1U : 0U;
      if (soak.chance(0.1)) servo.stall(clock.now() + 0.2 * soak.part());
      if (soak.chance(0.05)) servo.stepper().apply(HandSwitch::kForceOff);
      servo.stepper().apply(HandSwitch::kArm);  // after a fault, too
      for (const double longest = clock.now() + 0.3 * soak.part(); clock.now() < longest;) {
        (void)link->round();
        fake.arm.advance(clock.now());
        if (fake.buttons == 0U && clock.now() - released_at > 0.1) {
          ASSERT_EQ(fake.arm.force(), Vec3(0.0))
              << "the switch was let go " << clock.now() - released_at << " s ago";
        }
      }
      ASSERT_LE(fake.wire.largest(), kCap * (1.0 + 1e-12));
      ASSERT_LE(fake.wire.excess(), 1e-9) << "at " << clock.now() << " s";
      ASSERT_FALSE(servo.forced_outside) << "at " << clock.now() << " s";
    }
    link.reset();
    EXPECT_EQ(fake.arm.force(), Vec3(0.0)) << "a link that ended left a force";
    steps += servo.steps;
    crossings += servo.crossings;
    pulls += servo.pulls;
    faults += servo.faults;
  }
  std::printf(
      "  %llu steps, %llu crossings of the border, %llu pulls above 1 N, %llu steps of faults, %llu links\n",
      static_cast<unsigned long long>(steps), static_cast<unsigned long long>(crossings),
      static_cast<unsigned long long>(pulls), static_cast<unsigned long long>(faults),
      static_cast<unsigned long long>(links));
  EXPECT_GT(crossings, static_cast<std::uint64_t>(seconds));
  EXPECT_GT(pulls, steps / 50);
  EXPECT_GT(faults, steps / 1000);
  fake = FakeDhd();
}

}  // namespace
}  // namespace palpate::test
