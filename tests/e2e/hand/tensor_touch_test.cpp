// Feeling tensors from the command line: what holds the probe, what is logged and saved, and replays.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "common/field/analytic/tensor_examples.h"
#include "common/hand/mode/chain_description.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/hand/probe_session.h"
#include "common/servo/fault_recorder.h"
#include "tests/e2e/explorer_test.h"
#include "tests/e2e/hand/probe_log.h"

namespace palpate::test {
namespace {

constexpr double kVoxel = 2.0;  // of the examples [mm]

class TensorTouch : public ExplorerTest {
 protected:
  TensorTouch() : ExplorerTest("dtmri") {}
};

/// A hand that is led along the centre line of the helix for two turns, up to 1.3 mm beside it.
std::vector<PathRow> along_the_helix(const CenterLine& line) {
  constexpr int kSteps = 20'000;
  constexpr double kTwoTurns = 2.0 / 3.0;  // of the centre line's three
  std::vector<PathRow> rows;
  for (int n = 0; n <= kSteps; ++n) {
    const double part = static_cast<double>(n) / kSteps;
    const double u = 0.1 + kTwoTurns * part;
    const Vec3 x = line.position(u);
    const Vec3 outward = glm::normalize(Vec3{x.x, x.y, 0.0});
    const double turns = 4.0 * std::numbers::pi * part;
    rows.push_back(
        {1e-3 * n, x + std::sin(7.0 * turns) * outward + Vec3{0.0, 0.0, 0.8 * std::sin(11.0 * turns)}});
  }
  return rows;
}

double distance_to(const CenterLine& line, const Vec3& x, double near_u) {
  double least = HUGE_VAL;
  for (int n = -100; n <= 100; ++n)
    least = std::min(least, glm::distance(x, line.position(near_u + 2e-4 * n)));
  return least;
}

TEST_F(TensorTouch, HoldsTheProxyToTheCenterLineOfTheHelixForTwoTurns) {
  const CenterLine line = tensor_formula("helix")->center_lines().front();
  const std::vector<PathRow> path = along_the_helix(line);
  folder_.write("path.csv", path_table(path));
  for (const std::string mode : {"anisotropy", "anisotropy-point"}) {
    const Json summary = json({"probe", "--example", "helix", "--mode", mode, "--path", "path.csv", "--out",
                               mode + ".csv", "--tract", mode + ".vtp"});
    EXPECT_EQ(summary["states"]["held"], path.size()) << mode;
    EXPECT_EQ(summary["tracts"], 1) << mode;
    EXPECT_GT(summary["max_force_n"], 0.1) << mode;
    const ProbeLogText log = read_probe_log(folder_.path(mode + ".csv"));
    EXPECT_TRUE(log.header.ends_with(",p1x,p1y,p1z,force,cl,cp,cs,fa")) << log.header;
    ASSERT_EQ(log.rows.size(), path.size());
    double hand = 0.0;
    double proxy = 0.0;
    for (std::size_t n = 0; n < path.size(); n += 25) {
      const double u = 0.1 + 2.0 / 3.0 * static_cast<double>(n) / static_cast<double>(path.size() - 1);
      hand = std::max(hand, distance_to(line, path[n].position, u));
      proxy = std::max(proxy, distance_to(line, log.rows[n].proxy, u));
    }
    EXPECT_GT(hand, 1.0) << "the hand was never beside the line";
    EXPECT_LT(proxy, 0.2 * kVoxel) << mode;
  }
}

TEST_F(TensorTouch, MeasuresTheTensorAtTheProxy) {
  folder_.write("path.csv", "t,x,y,z\n0,1,2,3\n0.001,1.5,2,3\n");
  ASSERT_EQ(run({"probe", "--example", "planar", "--path", "path.csv", "--out", "log.csv"}).exit_code, 0);
  const ProbeLogText log = read_probe_log(folder_.path("log.csv"));
  ASSERT_EQ(log.lines.size(), 2U);
  // (1.0, 1.0, 0.3) 10^-3 mm^2/s: c_l = 0, c_p = 1.4 / 2.3, c_s = 0.9 / 2.3.
  std::vector<double> cells;
  std::istringstream text(log.lines[1]);
  for (std::string cell; std::getline(text, cell, ',');) cells.push_back(std::strtod(cell.c_str(), nullptr));
  ASSERT_GE(cells.size(), 5U);
  const auto last = cells.end();
  EXPECT_NEAR(last[-4], 0.0, 0.01);
  EXPECT_NEAR(last[-3], 1.4 / 2.3, 0.01);
  EXPECT_NEAR(last[-2], 0.9 / 2.3, 0.01);
}

TEST_F(TensorTouch, IsFreeInIsotropicPlacesOrHoldsToAPoint) {
  folder_.write("path.csv", "t,x,y,z\n0,0,0,0\n0.001,1,0,0\n0.002,2,1,0\n");
  const auto force = [&](const std::string& mode) {
    return json({"probe", "--example", "isotropic", "--path", "path.csv", "--mode", mode, "--slew-cap",
                 "1e9"})["max_force_n"]
        .get<double>();
  };
  EXPECT_EQ(force("anisotropy"), 0.0);
  // The stretch is sqrt 5 mm of a diagonal of 80 sqrt 3 mm that is 0.25 m wide; below 8 mm it is all held.
  EXPECT_NEAR(force("anisotropy-point"), 200.0 * std::sqrt(5.0) * 0.25 / (80.0 * std::sqrt(3.0)), 1e-6);
}

TEST_F(TensorTouch, RefusesCurvesAndModesThatMakeNoSense) {
  folder_.write("path.csv", "t,x,y,z\n0,0,0,0\n");
  for (const std::string curve :
       {"4", "0:1,1:4", "0:0,0.5:4,1:2", "0:0,0:1", "0:0,1:-4", "0:0,1:nan", "up"}) {
    const ProgramResult result = run({"probe", "--example", "straight", "--path", "path.csv", "--out",
                                      "log.csv", "--anisotropy-curve", curve});
    EXPECT_EQ(result.exit_code, 2) << curve;
    EXPECT_NE(result.err.find("--anisotropy-curve"), std::string::npos) << result.err;
  }
  const ProgramResult result =
      run({"probe", "--example", "straight", "--path", "path.csv", "--mode", "fibre", "--out", "log.csv"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("anisotropy-point"), std::string::npos) << result.err;
  EXPECT_EQ(files(), std::vector<std::string>{"path.csv"});
}

TEST_F(TensorTouch, PlaysRecordingsBackToTheBit) {
  const auto modes = modes_of(FieldKind::kTensor);
  const auto field = make_tensor_field(tensor_example("eigenvalue-crossing"), {.array = "tensor"}, "");
  const NamedField open{.name = field_key("example eigenvalue-crossing tensor", 0), .tensor = field};
  const double scale = Workspace::default_scale(field->bounds().diagonal());
  for (const HapticMode& mode : modes) {
    ChainSettings settings;
    ASSERT_FALSE(HapticTransferFunction::read("0:0,0.3:0.002,1:0.01,smooth", settings.anisotropy.tau));
    const std::string description = describe_chain(mode.name, scale, settings, open.name);
    RecordingHeader header{.program = "dtmri"};
    header.values.emplace_back("example", "eigenvalue-crossing");
    {
      FaultRecorder faults(folder_.path(mode.name), header, 1000.0);
      HandStepper stepper(nullptr, {});
      faults.change(0, ChainChange{faults.describe_chain(description)});
      (void)stepper.exchange_chain(build_chain(description, modes, open, 1).chain);
      for (int i = 0; i < 6000; ++i) {
        const double t = 0.001 * i;
        const Vec3 x = 30.0 * Vec3{std::sin(2.0 * t), std::cos(3.0 * t), std::sin(t)};
        HandInput input{.time = t, .present = i < 1500 || i > 1510, .sample = {t, scale * x, 0}};
        if (i == 5990) input.sample.position.x = std::numeric_limits<double>::quiet_NaN();
        faults.step(input, stepper.step(input));
      }
    }
    const Json summary =
        json({"probe", "--example", "eigenvalue-crossing", "--replay", mode.name + "/dtmri-fault-1.rec"});
    EXPECT_TRUE(summary["replay"].get<std::string>().starts_with("identical")) << summary["replay"];
    EXPECT_EQ(summary["mode"], mode.name);
  }
}

// What the window records of a tract that is drawn is what `probe --replay` draws again, bit by bit.
TEST_F(TensorTouch, ATractDrawnByHandIsRepeatedToTheBit) {
  const auto field = make_tensor_field(tensor_example("straight"), {.array = "tensor"}, "");
  const Vec3 start = field->bounds().center();
  {
    ProbeSessionOptions options;
    options.modes = modes_of(FieldKind::kTensor);
    options.record = folder_.path("run.txt");
    options.recorded.program = "dtmri";
    ProbeSession session(options, [] {});
    session.set_field({.name = field_key("example straight tensor", 0), .tensor = field});
    ASSERT_TRUE(session.data().has_tensors());
    const Camera camera = make_camera(field->bounds(), {}, 1.5);
    ProbeView view;
    session.grab(0.0, start);
    session.hand().press(true);
    for (int frame = 1; frame <= 60; ++frame) {
      const double t = 0.016 * frame;
      session.hand().move(start + t * Vec3{12.0, 3.0, 2.0});
      session.update(t, camera, LineStyle{}, view);
      std::this_thread::sleep_for(std::chrono::milliseconds(16));
    }
    session.hand().press(false);
    session.finish();
  }
  const Json summary = json({"probe", "--example", "straight", "--replay", "run.txt"});
  EXPECT_TRUE(summary["replay"].get<std::string>().starts_with("identical")) << summary["replay"];
  EXPECT_EQ(summary["replay_differs"], false);
  EXPECT_GT(summary["states"]["held"].get<int>(), 200);
}

}  // namespace
}  // namespace palpate::test
