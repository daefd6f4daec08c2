// `flow --device falcon`, on an emulated Falcon: in simulated time beside the simulated arm of the same
// physics, and as a window that a user opens.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/json.h"
#include "common/device/driver/falcon/falcon_link.h"
#include "common/servo/recording.h"
#include "tests/common/device/driver/falcon/falcon_emulator.h"
#include "tests/common/device/driver/transport/fake_usb.h"
#include "tests/e2e/hand/hand_in_flow.h"

namespace palpate::test {
namespace {

// Two independent models of the arm (exact pieces of an axis against steps of a whole one), two ways to read
// it (a grid of positions against three encoders), one operator and one line: the hand goes the same way and
// feels the same. What remains is friction, which holds either where it holds it.
using FalconInTheFlow = HandInFlow;

TEST_F(FalconInTheFlow, FeelsAsTheSimulatedArmOfTheSamePhysics) {
  FakeUsb bus;
  const auto falcon = std::make_shared<FalconEmulator>(
      EmulatedFalcon{.hand = kHand, .loaded = true, .homed = true, .start = FalconEmulator::kMiddle});
  bus.plug("1-2", falcon);
  FalconLink link(bus, {});
  const std::vector<Moment> real = on_device(
      link, [&] { return bus.now(); },
      [&](const Vec3& x) { falcon->set_target(FalconEmulator::kMiddle + x); });
  ASSERT_GT(real.size(), 5000U);
  const Apart far = apart(real, on_simulated());
  RecordProperty("probe_part", std::to_string(far.probe));
  RecordProperty("force_part", std::to_string(far.force));
  EXPECT_GT(far.pushed, 0.2) << "the line is not felt";
  EXPECT_LT(far.probe, 0.02);
  EXPECT_LT(far.force, 0.03);
}

std::string text_of_file(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

class FalconWindow : public ExplorerTest {
 protected:
  FalconWindow() : ExplorerTest("flow") {}

  /// Opens a window until `steps` steps are recorded. @param maps what the program had mapped then.
  ProgramResult open(std::vector<std::string> arguments, int steps, std::string& maps) {
    std::filesystem::remove(folder_.path("run.txt"));
    std::vector<std::string> command{bin("flow").string(), "open",   "--example", "tornado",
                                     "--record",           "run.txt"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    Program program(command, folder_.path());
    constexpr double kLimit = 60.0;    // [s]
    constexpr int kMostUnmapped = 20;  // looks in a row
    int unmapped = 0;
    const std::string number = " " + std::to_string(steps) + " ";
    while (program.seconds() < kLimit) {
      const std::string text = text_of_file(folder_.path("run.txt"));
      const bool enough =
          text.find("\ns" + number) != std::string::npos || text.find("\nn" + number) != std::string::npos;
      // Nothing is mapped for a moment while the program starts, and for good once it has ended.
      const std::string mapped = text_of_file("/proc/" + std::to_string(program.pid()) + "/maps");
      unmapped = mapped.empty() ? unmapped + 1 : 0;
      if (!mapped.empty()) maps = mapped;
      if (enough || unmapped > kMostUnmapped) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    program.signal(SIGINT);
    return program.finish();
  }
};

TEST_F(FalconWindow, IsMovedByTheDeviceAndRepeatsToTheBit) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display: run under xvfb-run";
  std::string maps;
  const ProgramResult lived = open({"--device", "falcon_emulated:button=none"}, 4000, maps);
  EXPECT_EQ(lived.exit_code, 130) << lived.err;
  EXPECT_NE(maps.find("palpate_driver_falcon_emulated.so"), std::string::npos);
  EXPECT_EQ(maps.find("libusb"), std::string::npos) << "only the module of a real bus needs it";
  const Recording recording = read_recording(folder_.path("run.txt").string());
  const auto present = std::count_if(recording.steps.begin(), recording.steps.end(),
                                     [](const RecordedStep& step) { return step.input.present; });
  EXPECT_GT(present, 500);
  EXPECT_FALSE(recording.steps.front().input.present) << "before it was homed there was no hand";
  EXPECT_EQ(recording.header.limits.enabling_button, DeviceLimits::kNoButton);
  EXPECT_LE(recording.header.limits.force_cap, 8.0);
  EXPECT_TRUE(recording.header.limits.latch_faults);
  const ProgramResult again = run({"probe", "--example", "tornado", "--replay", "run.txt", "--json"});
  const auto summary = parse_json(again.out);
  ASSERT_TRUE(summary.is_object()) << again.err;
  EXPECT_EQ(summary["replay_differs"], false) << summary["replay"];
}

// The driver has a dead-man switch of its own; a workbench names another one. What it does to the force is
// seen in dead_man_test.
TEST_F(FalconWindow, SaysWhichSwitchLetsItShowForce) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display: run under xvfb-run";
  folder_.write("workbench.toml", "[interaction]\nenabling_button = 3\n");
  std::string maps;
  for (const auto& [workbench, button] : {std::pair{false, 2}, std::pair{true, 3}}) {
    std::vector<std::string> arguments{"--device", "falcon_emulated"};
    if (workbench) arguments.insert(arguments.end(), {"--workbench", "workbench.toml"});
    const ProgramResult lived = open(arguments, 200, maps);
    EXPECT_NE(lived.err.find("only while button " + std::to_string(button)), std::string::npos) << lived.err;
    const Recording recording = read_recording(folder_.path("run.txt").string());
    EXPECT_EQ(recording.header.limits.enabling_button, button);
  }
}

// The reference of the whole scheme: who plugs nothing in carries nothing.
TEST_F(FalconWindow, WithoutADeviceMapsNoDriverAndNoLibusb) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display: run under xvfb-run";
  for (const char* device : {"mouse", "simulated"}) {
    std::string maps;
    const ProgramResult lived = open({"--device", device}, 200, maps);
    EXPECT_EQ(lived.exit_code, 130) << lived.err;
    EXPECT_NE(maps.find("flow"), std::string::npos);
    EXPECT_EQ(maps.find("libusb"), std::string::npos);
    EXPECT_EQ(maps.find("palpate_driver"), std::string::npos);
  }
  // A library of headers shows in no map: its names would be in the program.
  EXPECT_EQ(text_of_file(bin("flow")).find("5beast"), std::string::npos);
  EXPECT_NE(text_of_file(bin("flow")).find("palpate"), std::string::npos);
}

TEST_F(FalconWindow, NamesDriversAndOptions) {
  const ProgramResult unknown = run({"open", "--example", "tornado", "--device", "mouse2"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("the drivers falcon"), std::string::npos) << unknown.err;
  const ProgramResult wrong = run({"open", "--example", "tornado", "--device", "falcon_emulated:gain=much"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("gain takes a number"), std::string::npos) << wrong.err;
}

}  // namespace
}  // namespace palpate::test
