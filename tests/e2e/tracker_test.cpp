// A tracker at an immersive workbench, as a user opens a window with it: the stylus at the station that the
// workbench names puts the probe where its calibrated tip is.

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "common/math/quaternion.h"
#include "common/servo/recording.h"
#include "tests/common/device/driver/polhemus_emulator.h"
#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

// The second station is the stylus; the tracker reports places that are 1 cm short in x, and the axes of the
// data are turned against its own.
const char* const kBench =
    "[tracker]\ndegree = 0\ncenter = [0, 0, 0]\nscale = 1\nposition = [[0.01, 0, 0]]\n"
    "orientation = [[0, 0, 0]]\n\n[stylus]\ntip = [0, 0, -0.12]\n\n[interaction]\ntechnique = \"immersive\"\n"
    "middle = [0.5, 0.1, -0.2]\nrotation = [0.6, 0.8, 0, 0]\ngain = 0.5\nstylus_station = 2\n"
    "hand_station = 1\n";

class TrackerWindow : public ExplorerTest {
 protected:
  TrackerWindow() : ExplorerTest("flow") { folder_.write("bench.toml", kBench); }

  /// Opens a window until `steps` steps are recorded.
  ProgramResult open(const std::string& device, int steps) {
    Program program({bin("flow").string(), "open", "--example", "tornado", "--workspace-scale", "0.1",
                     "--record", "run.txt", "--device", device, "--workbench", "bench.toml"},
                    folder_.path());
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
};

TEST_F(TrackerWindow, PutsTheProbeWhereTheTipOfTheStylusIs) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display: run under xvfb-run";
  const ProgramResult lived = open("polhemus_emulated:still=1", 3000);
  EXPECT_EQ(lived.exit_code, 130) << lived.err;
  const Recording recording = read_recording(folder_.path("run.txt").string());
  const auto present = [](const RecordedStep& step) { return step.input.present; };
  const auto last = std::find_if(recording.steps.rbegin(), recording.steps.rend(), present);
  ASSERT_NE(last, recording.steps.rend()) << "the tracker never had hold of the probe";
  // By hand: the tip of station 2, corrected, in the workspace about the middle of the data.
  const Vec3 tip = PolhemusEmulator::position(2, 0.0) + Vec3(0.01, 0.0, 0.0) +
                   PolhemusEmulator::orientation(2, 0.0) * Vec3(0.0, 0.0, -0.12);
  const Json info = json({"info", "--example", "tornado"});
  const auto corner = [&](const char* name) {
    const Json& at = info["bounds"][name];
    return Vec3(at[0], at[1], at[2]);
  };
  const Vec3 middle = 0.1 * 0.5 * (corner("lower") + corner("upper"));
  const Vec3 expected = middle + 0.5 * (Quat{0.6, 0.8, 0.0, 0.0} * (tip - Vec3(0.5, 0.1, -0.2)));
  constexpr double kRounding = 1e-6;  // [m] of single precision, in inches
  EXPECT_LT(glm::distance(last->input.sample.position, expected), kRounding);
  // What a tracker led is repeated to the bit without one.
  const Json again = json({"probe", "--example", "tornado", "--replay", "run.txt"});
  EXPECT_EQ(again["replay_differs"], false);
}

TEST_F(TrackerWindow, NeedsAWorkbenchForIt) {
  folder_.write("desk.toml", "[interaction]\ntechnique = \"desktop\"\n");
  const auto refused = [this](const std::string& device, const std::string& bench) {
    const ProgramResult result =
        run({"open", "--example", "tornado", "--device", device, "--workbench", bench});
    EXPECT_EQ(result.exit_code, 2) << result.err;
    return result.err;
  };
  EXPECT_NE(refused("polhemus_emulated", "desk.toml").find("immersive"), std::string::npos);
  EXPECT_NE(refused("falcon_emulated", "bench.toml").find("--device polhemus"), std::string::npos);
  EXPECT_NE(refused("polhemus_emulated:hemisphere=up", "bench.toml").find("+x"), std::string::npos);
}

}  // namespace
}  // namespace palpate::test
