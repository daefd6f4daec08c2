// flow's window and its recordings, as a user has them: `open --record`, `open --replay`, `probe --replay`.

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <string>
#include <thread>

#include "common/field/analytic/examples.h"
#include "common/hand/probe_session.h"
#include "common/servo/recording.h"
#include "tests/common/hand/sample_modes.h"
#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

class TouchWindow : public ExplorerTest {
 protected:
  TouchWindow() : ExplorerTest("flow") {}

  static bool wait_for(const std::function<bool()>& happened) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!happened()) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
  }

  /// `open` with a window, which Ctrl-C in the terminal closes once `ready` says so. Where the window is in a
  /// frame that takes longer than the grace of Ctrl-C, the program ends without it; what is asserted of the
  /// recording holds in either case.
  ProgramResult open_until(const std::vector<std::string>& arguments, const std::function<bool()>& ready,
                           const char* explorer = "flow") {
    std::vector<std::string> command{bin(explorer).string(), "open"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    Program program(command, folder_.path());
    EXPECT_TRUE(wait_for(ready));
    program.signal(SIGINT);
    return program.finish();
  }

  /// Leads a hand through the tornado, as the window would, and records it to run.txt.
  void record_a_hand() {
    ProbeSessionOptions options;
    options.modes = sample_modes();
    options.record = folder_.path("run.txt");
    options.recorded.program = "flow";
    ProbeSession session(options, [] {});
    const auto field = make_vector_field(example("tornado"));
    session.set_field({field, field_key("example tornado velocity", 0)});
    const Vec3 start = field->bounds().lower + 0.4 * (field->bounds().upper - field->bounds().lower);
    const Camera camera = make_camera(field->bounds(), {}, 1.5);
    ProbeView view;
    session.grab(0.0, start);
    for (int frame = 1; frame <= 60; ++frame) {
      const double t = 0.016 * frame;
      session.hand().move(start + 0.3 * t * Vec3{1.0, -1.0, 0.3});
      session.update(t, camera, LineStyle{}, view);
      std::this_thread::sleep_for(std::chrono::milliseconds(16));
    }
    session.finish();
  }
};

TEST_F(TouchWindow, AHandOfTheWindowIsRepeatedByProbeToTheLastBit) {
  record_a_hand();
  const Recording recording = read_recording(folder_.path("run.txt").string());
  ASSERT_GT(recording.steps.size(), 300U);
  const Json summary = json({"probe", "--example", "tornado", "--replay", "run.txt", "--out", "log.csv"});
  const std::string steps = std::to_string(recording.steps.size());
  EXPECT_EQ(summary["replay"], "identical: " + steps + " of " + steps + " steps");
  EXPECT_EQ(summary["replay_differs"], false);
  EXPECT_GT(summary["states"]["held"].get<int>(), 200);
  EXPECT_GT(summary["states"]["released"].get<int>(), 0) << "it was pulled over";
  EXPECT_LE(summary["max_force_n"].get<double>(), 4.0);
  EXPECT_LE(summary["max_residual_per_diagonal"].get<double>(), 1e-6);
  EXPECT_FALSE(read_file(folder_.path("log.csv")).empty());
}

TEST_F(TouchWindow, AnotherHandIsToldFromIt) {
  record_a_hand();
  std::string text = read_file(folder_.path("run.txt"));
  const std::string softer = " stiffness=200 ", stiffer = " stiffness=201 ";
  std::size_t at = text.find(softer);
  ASSERT_NE(at, std::string::npos);
  for (; at != std::string::npos; at = text.find(softer, at)) text.replace(at, softer.size(), stiffer);
  folder_.write("other.txt", text);
  std::vector<std::string> arguments{"probe", "--example", "tornado", "--replay", "other.txt", "--json"};
  const ProgramResult result = run(arguments);
  const Json summary = parse_json(result.out);
  ASSERT_TRUE(summary.is_object()) << result.err;
  EXPECT_EQ(summary["replay_differs"], true);
  EXPECT_NE(result.exit_code, 0);
}

TEST_F(TouchWindow, ARecordingThatWasCutOffIsGoodUpToThere) {
  record_a_hand();
  const std::string text = read_file(folder_.path("run.txt"));
  folder_.write("cut.txt", text.substr(0, text.size() / 2));
  const Json summary = json({"probe", "--example", "tornado", "--replay", "cut.txt"});
  EXPECT_NE(summary["replay"].get<std::string>().find("identical"), std::string::npos) << summary["replay"];
}

TEST_F(TouchWindow, ModeAndSettingsAreThoseOfTheRecording) {
  record_a_hand();
  const Json summary = json({"probe", "--example", "tornado", "--replay", "run.txt"});
  EXPECT_EQ(summary["mode"], "streamline");
  EXPECT_EQ(summary["stiffness_n_per_m"], 200.0);
  for (const std::vector<std::string>& option : {std::vector<std::string>{"--stiffness", "999"},
                                                 {"--mode", "isotropic"},
                                                 {"--workspace-scale", "2"}}) {
    std::vector<std::string> arguments{"probe", "--example", "tornado", "--replay", "run.txt", "--json"};
    arguments.insert(arguments.end(), option.begin(), option.end());
    const ProgramResult refused = run(arguments);
    EXPECT_EQ(refused.exit_code, 2) << option[0];
    EXPECT_NE(refused.err.find(option[0]), std::string::npos) << refused.err;
  }
}

TEST_F(TouchWindow, AnInputThatWasNotRecordedIsNamed) {
  record_a_hand();
  std::string text = read_file(folder_.path("run.txt"));
  text.insert(text.find("limits "), "input 5 " + std::string(64, '0') + " elsewhere.vtk\n");
  folder_.write("other.txt", text);
  const Json summary = json({"probe", "--example", "tornado", "--replay", "other.txt"});
  ASSERT_EQ(summary["changed_inputs"].size(), 1U);
  EXPECT_NE(summary["changed_inputs"][0].get<std::string>().find("elsewhere.vtk"), std::string::npos);
}

TEST_F(TouchWindow, IsOfOneFieldOnly) {
  record_a_hand();
  const ProgramResult other = run({"probe", "--example", "abc", "--replay", "run.txt", "--json"});
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_NE(other.err.find("tornado"), std::string::npos) << other.err;
}

TEST_F(TouchWindow, TheWindowRecordsAndReplays) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display: run under xvfb-run";
  const auto file = folder_.path("run.txt");
  const ProgramResult lived = open_until({"--example", "tornado", "--record", "run.txt"}, [&] {
    return read_file(file).find("\nn 500 ") != std::string::npos;
  });
  EXPECT_EQ(lived.exit_code, 130) << lived.err;
  const Recording recording = read_recording(file.string());
  EXPECT_TRUE(recording.ended) << "Ctrl-C ends it in order";
  EXPECT_EQ(lived.err.find("nothing was saved"), std::string::npos) << lived.err;
  EXPECT_FALSE(recording.header.build.empty());
  EXPECT_EQ(recording.header.values.front(), std::pair(std::string("example"), std::string("tornado")));
  EXPECT_EQ(json({"probe", "--example", "tornado", "--replay", "run.txt"})["replay_differs"], false);

  const std::string before = read_file(file);
  const ProgramResult again =
      Program({bin("flow").string(), "open", "--example", "tornado", "--record", "run.txt"}, folder_.path())
          .finish();
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_EQ(read_file(file), before);

  int looks = 0;
  const ProgramResult replayed =
      open_until({"--example", "tornado", "--replay", "run.txt"}, [&] { return ++looks > 100; });
  EXPECT_EQ(replayed.exit_code, 130) << replayed.err;
  EXPECT_EQ(read_file(file), before);
}

TEST_F(TouchWindow, AHandOnAVolumeIsRecordedAndRepeated) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display: run under xvfb-run";
  const auto file = folder_.path("run.txt");
  const ProgramResult lived = open_until(
      {"--example", "blob", "--mode", "isosurface", "--device", "simulated", "--record", "run.txt"},
      [&] { return read_file(file).find("\ns 500 ") != std::string::npos; }, "grid");
  EXPECT_EQ(lived.exit_code, 130) << lived.err;
  const Recording recording = read_recording(file.string());
  EXPECT_TRUE(recording.ended);
  EXPECT_GE(recording.steps.size(), 500U);
  const ProgramResult again =
      Program({bin("grid").string(), "probe", "--example", "blob", "--replay", "run.txt", "--json"},
              folder_.path())
          .finish();
  const Json summary = parse_json(again.out);
  ASSERT_TRUE(summary.is_object()) << again.err;
  EXPECT_EQ(summary["replay_differs"], false) << summary["replay"];
  EXPECT_EQ(summary["mode"], "isosurface");
}

}  // namespace
}  // namespace palpate::test
