// `workbench tune` on an emulated Falcon that nobody holds, at the wire, in simulated time.

#include <memory>

#include <gtest/gtest.h>

#include "common/device/driver/falcon/falcon_link.h"
#include "common/servo/tuning_run.h"
#include "tests/common/device/driver/falcon/falcon_emulator.h"
#include "tests/common/device/driver/round_with.h"
#include "tests/common/device/driver/transport/fake_usb.h"

namespace palpate::test {
namespace {

/// A link whose rounds are the servo's steps, in the frame of the device.
class SteppedLink final : public Device {
 public:
  SteppedLink(FakeUsb& bus, DriverLink& link) : bus_(bus), link_(link), limits_(link.limits()) {
    limits_.enabling_button = DeviceLimits::kNoButton;  // a hand on it would hold the arm
    while (link_.status().phase != LinkPhase::kReady && bus_.now() < 20.0) (void)round_with(link_, Vec3{0.0});
  }

  bool read(double now, DeviceSample& sample) noexcept override {
    (void)round_with(link_, force_);
    sample = {now, link_.atoms().position, link_.atoms().buttons};
    return link_.atoms().has_position;
  }
  void command(const Vec3& force) noexcept override { force_ = force; }
  void emergency_stop() noexcept override { force_ = Vec3{0.0}; }
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }

 private:
  FakeUsb& bus_;
  DriverLink& link_;
  DeviceLimits limits_;
  Vec3 force_{0.0};
};

// Its own kinematics and dynamics: 0.6 kg, 3 N s/m, 0.7 N of friction, a millisecond of bridge each way.
// Below (b) / (T/2 + t_d) = 2000 N/m nothing may swing; stiff enough, anything does.
TEST(FalconTuning, FindsWhatAnEmulatedFalconBears) {
  FakeUsb bus;
  const auto falcon = std::make_shared<FalconEmulator>(
      EmulatedFalcon{.hand = 0.0, .loaded = true, .homed = true, .start = FalconEmulator::kMiddle});
  bus.plug("1-2", falcon);
  FalconLink link(bus, {});
  SteppedLink device(bus, link);
  const TuningPlan plan{.places = {Vec3{0.0}, Vec3{0.02, 0.0, 0.0}}, .most = 2e4};
  const TuningNews news = run_tuning(device, plan, nullptr);
  for (std::size_t i = 0; i < news.count; ++i) {
    const TuningResult& at = news.results[i];
    EXPECT_TRUE(says_something(at.end)) << name_of(at.end);
    EXPECT_GT(at.stable, 1500.0) << i;
    EXPECT_GT(at.unstable, at.stable) << "20 kN/m is more than any Falcon bears";
  }
  EXPECT_LE(falcon->largest_force(), 1.1 * link.limits().force_cap);
  // Zero is the last command.
  (void)round_with(link, Vec3{0.0});
  EXPECT_EQ(falcon->motors(), (std::array<int, 3>{}));
}

}  // namespace
}  // namespace palpate::test
