// `flow --device falcon`, on an emulated Falcon: in simulated time beside the simulated arm of the same
// physics, and as a window that a user opens.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "apps/flow/flow_modes.h"
#include "common/app/haptic/haptic_mode.h"
#include "common/device/driver/falcon_link.h"
#include "common/device/simulated_device.h"
#include "common/field/analytic/examples.h"
#include "common/servo/hand_step.h"
#include "common/servo/recording.h"
#include "tests/common/device/driver/fake_usb.h"
#include "tests/common/device/driver/falcon_emulator.h"
#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

struct Moment {
  double time = 0.0;
  Vec3 probe{0.0}, force{0.0};
};

/// Where the hand wants to be, from the middle of the data [m].
Vec3 wanted(double time) {
  const double t = std::max(0.0, time - 1.0);
  return 0.02 * Vec3{std::sin(1.3 * t), std::sin(0.9 * t), std::sin(1.7 * t)};
}

/// A leader that is where `wanted` says.
class Wanting final : public Device {
 public:
  explicit Wanting(const Vec3& middle) : middle_(middle) {}
  bool read(double now, DeviceSample& sample) noexcept override {
    sample = {now, middle_ + wanted(now), 1U};
    return true;
  }
  void command(const Vec3& /*force*/) noexcept override {}
  void emergency_stop() noexcept override {}
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }

 private:
  Vec3 middle_;
  DeviceLimits limits_;
};

constexpr double kEnd = 12.0;  // [s]

class FalconInTheFlow : public ExplorerTest {
 protected:
  FalconInTheFlow()
      : ExplorerTest("flow"),
        field_(make_vector_field(example("abc"))),
        workspace_(Workspace::default_scale(field_->diagonal()), {}),
        middle_(workspace_.workspace_from_data(field_->bounds().center())) {
    limits_ = safe_limits(find_profile("falcon"));
    limits_.reach_lower = Vec3{-HUGE_VAL};
    limits_.reach_upper = Vec3{HUGE_VAL};
  }

  /// The streamline that is felt does not let go: which of two lines holds would be a matter of rounding.
  [[nodiscard]] std::unique_ptr<ProxyChain> chain() const {
    ChainSettings settings;
    settings.stiffness = 150.0;
    settings.streamline.release_distance = 1.0;
    return flow_modes().front().make({field_, workspace_, settings, 1, nullptr, nullptr}).chain;
  }

  [[nodiscard]] std::vector<Moment> on_falcon() const {
    FakeUsb bus;
    const auto falcon = std::make_shared<FalconEmulator>(
        EmulatedFalcon{.loaded = true, .homed = true, .start = FalconEmulator::kMiddle});
    bus.plug("1-2", falcon);
    FalconLink link(bus, {});
    HandStepper stepper(chain(), limits_);
    std::vector<Moment> moments;
    Vec3 force{0.0};
    while (bus.now() < kEnd) {
      falcon->set_target(FalconEmulator::kMiddle + wanted(bus.now()));
      if (!link.round(force)) continue;
      const DeviceAtoms& atoms = link.atoms();
      const HandStep step = stepper.step({.time = bus.now(),
                                          .present = true,
                                          .sample = {atoms.time, middle_ + atoms.position, atoms.buttons}});
      force = step.force;
      moments.push_back({bus.now(), step.probe, step.force});
    }
    return moments;
  }

  [[nodiscard]] std::vector<Moment> on_simulated() const {
    SimulatedDeviceOptions options{.profile = find_profile("falcon"),
                                   .hand = {.mass = 0.0, .damping = 0.0, .stiffness = EmulatedFalcon{}.hand},
                                   .operator_settings = {.reaction = 0.0, .lag = 0.0, .tremor = 0.0},
                                   .limits = limits_};
    Wanting leader(middle_);
    SimulatedDevice device(options, leader);
    HandStepper stepper(chain(), limits_);
    std::vector<Moment> moments;
    for (double now = 0.0; now < kEnd; now += 0.001) {
      HandInput hand{.time = now};
      hand.present = device.read(now, hand.sample);
      const HandStep step = stepper.step(hand);
      device.command(step.force);
      moments.push_back({now, step.probe, step.force});
    }
    return moments;
  }

  std::shared_ptr<const VectorField> field_;
  Workspace workspace_;
  Vec3 middle_;
  DeviceLimits limits_;
};

/// The moment of `moments` at `time` or the one before.
const Moment& at(const std::vector<Moment>& moments, double time) {
  auto next = std::upper_bound(moments.begin(), moments.end(), time,
                               [](double t, const Moment& m) { return t < m.time; });
  return next == moments.begin() ? *next : *(next - 1);
}

// Two independent models of the arm (exact pieces of an axis against steps of a whole one), two ways to read
// it (a grid of positions against three encoders), one operator and one line: the hand goes the same way and
// feels the same. What remains is friction, which holds either where it holds it.
TEST_F(FalconInTheFlow, FeelsAsTheSimulatedArmOfTheSamePhysics) {
  const std::vector<Moment> real = on_falcon(), simulated = on_simulated();
  ASSERT_GT(real.size(), 5000U);
  double moved = 0.0, pushed = 0.0, apart = 0.0, differ = 0.0;
  int count = 0;
  for (double t = 2.0; t < kEnd - 0.01; t += 0.005, ++count) {
    const Moment &a = at(real, t), &b = at(simulated, t);
    const auto square = [](const Vec3& x) { return glm::dot(x, x); };
    moved += square(b.probe - middle_);
    pushed += square(b.force);
    apart += square(a.probe - b.probe);
    differ += square(a.force - b.force);
  }
  const double probe_part = std::sqrt(apart / moved), force_part = std::sqrt(differ / pushed);
  RecordProperty("probe_part", std::to_string(probe_part));
  RecordProperty("force_part", std::to_string(force_part));
  EXPECT_GT(std::sqrt(pushed / count), 0.2) << "the line is not felt";
  EXPECT_LT(probe_part, 0.02);
  EXPECT_LT(force_part, 0.03);
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
  const auto summary = nlohmann::json::parse(again.out, nullptr, false);
  ASSERT_TRUE(summary.is_object()) << again.err;
  EXPECT_EQ(summary["replay_differs"], false) << summary["replay"];
}

// The driver has a dead-man switch of its own; a workbench names another one. What it does to the force is
// seen in dead_man_test.
TEST_F(FalconWindow, SaysWhichSwitchLetsItShowForce) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display: run under xvfb-run";
  folder_.write("bench.toml", "[interaction]\nenabling_button = 3\n");
  std::string maps;
  for (const auto& [bench, button] : {std::pair{false, 2}, std::pair{true, 3}}) {
    std::vector<std::string> arguments{"--device", "falcon_emulated"};
    if (bench) arguments.insert(arguments.end(), {"--workbench", "bench.toml"});
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
