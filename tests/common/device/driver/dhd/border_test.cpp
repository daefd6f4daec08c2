// The whole way to a real link on its thread: servo, safety stage, placement, link and library, while the hand
// goes in and out of the reach and everything is changed on the way.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/device/driver/dhd/dhd_link.h"
#include "common/haptics/proxy_chain.h"
#include "common/servo/linked_device.h"
#include "common/servo/placed_device.h"
#include "common/servo/servo_loop.h"
#include "tests/common/device/driver/dhd/tether.h"
#include "tests/common/device/driver/fake_dhd.h"
#include "tests/support/project_folders.h"

namespace palpate::test {
namespace {

/// The link thread's, whose last answer is the time of what it does next.
class HeardClock final : public LinkClock {
 public:
  [[nodiscard]] double now() const noexcept override {
    const double now = clock_.now() - start_;
    last_.store(now, std::memory_order_relaxed);
    return now + start_;
  }
  void sleep(double seconds) noexcept override { clock_.sleep(seconds); }
  [[nodiscard]] double last() const noexcept { return last_.load(std::memory_order_relaxed); }

 private:
  SystemLinkClock clock_;
  const double start_ = clock_.now();
  mutable std::atomic<double> last_{0.0};
};

TEST(BorderOfTheReach, NoCommandOfARealLinkBreaksCapOrSlew) {
  constexpr double kCap = 3.0, kSlew = 50.0;
  const std::string file = (build_folder() / "tests" / "libpalpate_fake_dhd.so").string();
  const DhdFunctions functions = open_dhd_library(file);
  FakeDhd& fake = *fake_dhd_of(file);
  HeardClock clock;
  fake = FakeDhd();
  fake.now = [&clock] { return clock.last(); };
  fake.buttons = 1;
  fake.wire = ForceWitness(kSlew);

  DhdSettings settings;
  settings.arm.reach = 0.02;  // the hand wanders 0.03 about
  DeviceLimits limits = settings.arm.limits();
  limits.force_cap = kCap;
  limits.slew_cap = kSlew;
  limits.start_ramp = 0.05;
  limits.velocity_gate = HUGE_VAL;
  limits.stale_after = 0.2;  // a busy machine is no fault here
  limits.edge_stiffness = 0.0;
  std::uint64_t crossings = 0, pulls = 0;
  {
    LinkedDevice linked(std::make_shared<DhdLink>(functions, clock, settings), {.button = 0}, limits);
    Placement placement{.axes = Mat3{Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{1, 0, 0}}, .scale = 1.5};
    PlacedDevice placed(linked, limits, placement, {});
    std::vector<std::unique_ptr<Constraint>> links;
    links.push_back(std::make_unique<Tether>());
    ServoLoop servo(placed,
                    std::make_unique<ProxyChain>(std::move(links), ChainSettings{.stiffness = 2000.0}),
                    "anchor", {.real_time = false});
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(4);
    bool outside = false;
    const auto latest = until + std::chrono::seconds(60);  // a busy machine
    const auto goes_on = [&] {
      const auto now = std::chrono::steady_clock::now();
      return now < until || (now < latest && (crossings < 4 || pulls < 100));
    };
    for (int n = 0; goes_on(); ++n) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      for (HandStep step; servo.pop_step(step);) {
        crossings += (step.cut == ForceCut::kOutOfReach) != outside ? 1U : 0U;
        outside = step.cut == ForceCut::kOutOfReach;
        pulls += glm::length(step.force) > 1.0 ? 1U : 0U;
      }
      if (n % 70 == 30) linked.emergency_stop();  // as a watchdog does, in the midst of a tick
      if (n % 110 == 60) {
        placement.middle.x += 0.001;
        placed.place(placement);
      }
      if (n % 150 == 90) servo.force_off();
      if (n % 40 == 0) servo.arm();  // after a fault, too
    }
  }
  EXPECT_GE(crossings, 4U);
  EXPECT_GE(pulls, 100U);
  EXPECT_LE(fake.wire.largest(), kCap * (1.0 + 1e-12));
  EXPECT_LE(fake.wire.excess(), 1e-9);
  EXPECT_EQ(fake.last, Vec3(0.0));
  RecordProperty("crossings", std::to_string(crossings));
  RecordProperty("largest_excess_mN", std::to_string(1e3 * fake.wire.excess()));
  fake = FakeDhd();
}

}  // namespace
}  // namespace palpate::test
