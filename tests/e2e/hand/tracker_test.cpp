// A tracker at an immersive workbench, as a user opens a window with it: the stylus at the station that the
// workbench names puts the probe where its calibrated tip is.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "common/math/quaternion.h"
#include "common/servo/recording.h"
#include "tests/common/device/driver/polhemus/polhemus_emulator.h"
#include "tests/e2e/explorer_test.h"
#include "tests/support/project_folders.h"

namespace palpate::test {
namespace {

// The second station is the stylus; the tracker reports places that are 1 cm short in x, and the axes of the
// data are turned against its own.
const char* const kBench =
    "[tracker]\ndegree = 0\ncenter = [0, 0, 0]\nscale = 1\nposition = [[0.01, 0, 0]]\n"
    "orientation = [[0, 0, 0]]\n\n[stylus]\ntip = [0, 0, -0.12]\n\n[interaction]\ntechnique = \"immersive\"\n"
    "middle = [0.5, 0.1, -0.2]\nrotation = [0.6, 0.8, 0, 0]\ngain = 0.5\nstylus_station = 2\n"
    "hand_station = 1\nhead_station = 3\n\n[screen]\nlower_left = [0.3, -0.05, -0.2]\n"
    "lower_right = [0.7, -0.05, -0.2]\nupper_left = [0.3, 0.25, -0.2]\n";

// An arm whose frame D stands turned and moved in the tracker's frame.
const char* const kArmBench =
    "[coregistration]\nrotation = [0.6, 0, 0.8, 0]\ntranslation = [0.5, 0.1, -0.2]\nsensor = [0, 0, 0]\n\n"
    "[interaction]\ntechnique = \"immersive\"\nmiddle = [0.52, 0.1, -0.2]\nrotation = [0.6, 0.8, 0, 0]\n"
    "gain = 0.5\ntip_offset = [0, 0.01, 0]\n";

class TrackerWindow : public ExplorerTest {
 protected:
  TrackerWindow() : ExplorerTest("flow") {
    folder_.write("workbench.toml", kBench);
    folder_.write("arm.toml", kArmBench);
  }

  /// Opens a window until `steps` steps are recorded.
  ProgramResult open(const std::string& device, const std::string& workbench, int steps,
                     const std::string& head = "") {
    std::vector<std::string> command{bin("flow").string(), "open", "--example",   "tornado",
                                     "--workspace-scale",  "0.1",  "--record",    "run.txt",
                                     "--device",           device, "--workbench", workbench};
    if (!head.empty()) command.insert(command.end(), {"--head", head});
    Program program(command, folder_.path());
    constexpr double kLimit = 60.0;  // [s]
    const std::string number = " " + std::to_string(steps) + " ";
    while (program.seconds() < kLimit) {
      std::ifstream in(folder_.path("run.txt"));
      std::ostringstream text;
      text << in.rdbuf();
      const std::string said = text.str();
      if (said.find("\ns" + number) != std::string::npos || said.find("\nn" + number) != std::string::npos)
        break;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    program.signal(SIGINT);
    return program.finish();
  }

  /// Where the probe was last, and the middle of the data, in the workspace.
  [[nodiscard]] std::optional<Vec3> last_probe() {
    const Recording recording = read_recording(folder_.path("run.txt").string());
    const auto present = [](const RecordedStep& step) { return step.input.present; };
    const auto last = std::find_if(recording.steps.rbegin(), recording.steps.rend(), present);
    return last == recording.steps.rend() ? std::nullopt : std::optional(last->input.sample.position);
  }
  [[nodiscard]] Vec3 middle() {
    const Json info = json({"info", "--example", "tornado"});
    const auto corner = [&](const char* name) {
      const Json& at = info["bounds"][name];
      return Vec3(at[0], at[1], at[2]);
    };
    return 0.1 * 0.5 * (corner("lower") + corner("upper"));
  }
};

TEST_F(TrackerWindow, PutsTheProbeWhereTheTipOfTheStylusIs) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display: run under xvfb-run";
  // The head is on the same tracker, which can be opened once only.
  const ProgramResult lived = open("polhemus_emulated:still=1", "workbench.toml", 3000, "polhemus_emulated");
  EXPECT_EQ(lived.exit_code, 130) << lived.err;
  const auto last = last_probe();
  ASSERT_TRUE(last) << "the tracker never had hold of the probe";
  // By hand: the tip of station 2, corrected, in the workspace about the middle of the data.
  const Vec3 tip = PolhemusEmulator::position(2, 0.0) + Vec3(0.01, 0.0, 0.0) +
                   PolhemusEmulator::orientation(2, 0.0) * Vec3(0.0, 0.0, -0.12);
  const Vec3 expected = middle() + 0.5 * (Quat{0.6, 0.8, 0.0, 0.0} * (tip - Vec3(0.5, 0.1, -0.2)));
  constexpr double kRounding = 1e-6;  // [m] of single precision, in inches
  EXPECT_LT(glm::distance(*last, expected), kRounding);
  // What a tracker led is repeated to the bit without one.
  const Json again = json({"probe", "--example", "tornado", "--replay", "run.txt"});
  EXPECT_EQ(again["replay_differs"], false);
}

// An arm at the workbench: its tip is where the hand is, whichever way the view is.
TEST_F(TrackerWindow, PutsTheProbeWhereTheTipOfACoregisteredArmIs) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display: run under xvfb-run";
  const std::string device =
      "openhaptics:name=Worn arm,library=" + (build_folder() / "tests/libpalpate_fake_hd.so").string();
  const ProgramResult lived = open(device, "arm.toml", 2000);
  EXPECT_EQ(lived.exit_code, 130) << lived.err;
  const auto last = last_probe();
  ASSERT_TRUE(last) << lived.err;
  // The worn arm says this of itself, by its encoders that are off: its own model, by hand.
  const double lift = std::atan2(-0.02, std::hypot(0.28, 0.03));
  const double reach2 = 0.28 * 0.28 + 0.03 * 0.03 + 0.02 * 0.02;
  const double elbow = std::acos((reach2 - 0.21 * 0.21 - 0.17 * 0.17) / (2.0 * 0.21 * 0.17));
  const double base = std::atan2(0.03, 0.28) - 0.06;
  const double thigh = lift + std::atan2(0.17 * std::sin(elbow), 0.21 + 0.17 * std::cos(elbow)) + 0.05;
  const double shin = thigh - elbow - 0.08;
  const double out = 0.21 * std::cos(thigh) + 0.17 * std::cos(shin);
  const Vec3 own{out * std::sin(base), 0.21 * std::sin(thigh) + 0.17 * std::sin(shin),
                 out * std::cos(base) - 0.24};
  const Vec3 at_workbench = Quat{0.6, 0.0, 0.8, 0.0} * own + Vec3(0.5, 0.11, -0.2);
  const Vec3 expected = middle() + 0.5 * (Quat{0.6, 0.8, 0.0, 0.0} * (at_workbench - Vec3(0.52, 0.1, -0.2)));
  constexpr double kRounding = 1e-9;  // [m]
  EXPECT_LT(glm::distance(*last, expected), kRounding);
}

TEST_F(TrackerWindow, NeedsAWorkbenchForIt) {
  folder_.write("desk.toml", "[interaction]\ntechnique = \"desktop\"\n");
  const auto refused = [this](const std::string& device, const std::string& workbench) {
    const ProgramResult result =
        run({"open", "--example", "tornado", "--device", device, "--workbench", workbench});
    EXPECT_EQ(result.exit_code, 2) << result.err;
    return result.err;
  };
  EXPECT_NE(refused("polhemus_emulated", "desk.toml").find("immersive"), std::string::npos);
  EXPECT_NE(refused("falcon_emulated", "workbench.toml").find("[coregistration]"), std::string::npos);
  EXPECT_NE(refused("polhemus_emulated:hemisphere=up", "workbench.toml").find("+x"), std::string::npos);
}

}  // namespace
}  // namespace palpate::test
