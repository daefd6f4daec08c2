#include "common/cli/simulated_option.h"

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/device/workbench_option.h"

namespace palpate::test {
namespace {

std::string refusal(const std::string& device) {
  try {
    (void)simulated_option(device);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    return error.what();
  }
  return "accepted";
}

TEST(SimulatedOption, NamesDeviceAndHandInAnyOrder) {
  EXPECT_FALSE(simulated_option("mouse"));
  EXPECT_FALSE(simulated_option("simulatedx"));
  EXPECT_FALSE(simulated_option("replay:simulated"));
  const auto of = [](const char* text) { return title_of(simulated_option(text).value()); };
  EXPECT_EQ(of("simulated"), "PHANToM Premium 3.0 class in a relaxed hand");
  EXPECT_EQ(of("simulated:falcon"), "Novint Falcon class in a relaxed hand");
  EXPECT_EQ(of("simulated:falcon,hand=firm"), "Novint Falcon class in a firm hand");
  EXPECT_EQ(of("simulated:hand=firm,falcon"), "Novint Falcon class in a firm hand");
  EXPECT_EQ(of("simulated:hand=relaxed"), "PHANToM Premium 3.0 class in a relaxed hand");
}

TEST(WorkbenchOption, TellsDevicesOfOneDriverApart) {
  const auto key = [](const char* text) { return device_key(parse_device(text)); };
  EXPECT_EQ(key("falcon:gain=3500"), "falcon");
  EXPECT_EQ(key("dhd:cap=3,serial=12"), "dhd:12");
  EXPECT_EQ(key("openhaptics:name=Right arm"), "openhaptics:Right arm");
  EXPECT_EQ(key("vrpn:Tracker0@lab,sensor=1"), "vrpn:Tracker0@lab");
  EXPECT_TRUE(is_same_device("polhemus", "polhemus:hemisphere=-z"));
  EXPECT_TRUE(is_same_device("vrpn:Head@lab", "vrpn:Head@lab"));
  EXPECT_FALSE(is_same_device("vrpn:Head@lab", "vrpn:Hand@lab"));
  EXPECT_FALSE(is_same_device("polhemus:port=/dev/ttyUSB0", "polhemus"));
  EXPECT_FALSE(is_same_device("vrpn", "polhemus"));
}

TEST(SimulatedOption, RefusesWhatItDoesNotKnow) {
  EXPECT_NE(refusal("simulated:omega").find("known are premium3, falcon, ideal"), std::string::npos);
  EXPECT_NE(refusal("simulated:").find("known are"), std::string::npos);
  EXPECT_NE(refusal("simulated:falcon,hand=limp").find("known are relaxed, firm"), std::string::npos);
  EXPECT_EQ(refusal("simulated:falcon,premium3"),
            "--device simulated:falcon,premium3: one device, one hand and one button at most");
  EXPECT_EQ(refusal("simulated:hand=firm,hand=firm"),
            "--device simulated:hand=firm,hand=firm: one device, one hand and one button at most");
}

TEST(SimulatedOption, HoldsTheForceToTheSafeLimitsOfItsClass) {
  const auto limits_of = [](const char* text, const DeviceLimits& asked) {
    return simulated_limits(simulated_option(text).value(), asked);
  };
  const DeviceLimits gentle{.force_cap = 2.0, .slew_cap = 50.0};
  const DeviceLimits strong{.force_cap = 100.0, .slew_cap = 1e4};
  for (const char* device : {"simulated:premium3", "simulated:falcon", "simulated:ideal"}) {
    const DeviceLimits limits = limits_of(device, gentle);
    EXPECT_TRUE(limits.valid());
    EXPECT_EQ(limits.force_cap, 2.0) << "what is asked for may be less";
    EXPECT_EQ(limits.slew_cap, 50.0);
    EXPECT_EQ(limits.start_ramp, 0.5);
    EXPECT_EQ(limits.velocity_gate, 1.5);
    EXPECT_TRUE(limits.latch_faults);
    EXPECT_EQ(limits.enabling_button, DeviceLimits::kNoButton);
    EXPECT_EQ(limits_of(device, strong).slew_cap, 200.0) << "but not more";
  }
  EXPECT_EQ(limits_of("simulated:falcon", strong).force_cap, 8.0);
  EXPECT_EQ(limits_of("simulated:premium3", strong).force_cap, 22.0);
  EXPECT_EQ(limits_of("simulated:premium3", strong).continuous_cap, 3.0);
  EXPECT_EQ(limits_of("simulated:falcon,button=3", gentle).enabling_button, 3);
}

TEST(SimulatedOption, RefusesButtonsThatAreNone) {
  for (const char* item : {"button=", "button=-1", "button=32", "button=0x1", "button=left"}) {
    EXPECT_NE(refusal("simulated:" + std::string(item)).find("a button from 0 to 31"), std::string::npos)
        << item;
  }
  EXPECT_NE(refusal("simulated:button=1,button=1").find("one button at most"), std::string::npos);
}

}  // namespace
}  // namespace palpate::test
