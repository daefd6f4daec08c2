// Recorder, read_recording and ReplaySource, without the loop: a run is stepped here, written, read and
// repeated.

#include "common/servo/recording.h"

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/files/kept_files.h"
#include "common/servo/recorder.h"
#include "common/servo/replay_source.h"
#include "tests/common/servo/sphere_drag.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

RecordingHeader header() {
  return {.program = "flow",
          .version = "0.1.0",
          .build = "GCC 12.2.0, Release",
          .inputs = {{"data/my heart.vtk", 2681486, std::string(64, 'a')}},
          .values = {{"mode", "streamline"}, {"seeds", "grid:8,8,8 of\nall"}, {"empty", ""}},
          .limits = {.force_cap = 3.3,
                     .slew_cap = 150.1,
                     .velocity_gate = HUGE_VAL,
                     .stale_after = 0.05,
                     .start_ramp = 0.01,
                     .fade_time = 0.03,
                     .continuous_cap = 2.2,
                     .heating_time = 3.0,
                     .reach_lower = {-1.1, -HUGE_VAL, -3.0},
                     .reach_upper = {1.5, 2.5, HUGE_VAL},
                     .edge_margin = 0.007,
                     .edge_stiffness = 310.0,
                     .enabling_button = 0}};
}

std::unique_ptr<ProxyChain> chain_from(const std::string& description) {
  return sphere_chain(std::stod(description));
}

/// Records `steps` steps of a hand that is held, lets go, gets nonsense, other settings and other chains.
/// @return the steps as they were.
std::vector<HandStep> record_run(const std::string& file, int steps, std::size_t capacity = 1U << 16U) {
  Recorder recorder(file, header(), true, capacity);
  HandStepper stepper(nullptr, header().limits);
  std::vector<HandStep> made;
  std::mt19937_64 random{17};
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto put_chain = [&](const std::string& description) {
    recorder.change(stepper.next_number(), ChainChange{recorder.describe_chain(description)});
    (void)stepper.exchange_chain(chain_from(description));
  };
  const auto change = [&](const auto& what) {
    recorder.change(stepper.next_number(), what);
    stepper.apply(what);
  };
  put_chain("0.05");
  double t = 1234.5678901234;
  Vec3 x{0.0, 0.0, 0.052};
  for (int i = 0; i < steps; ++i) {
    t += 0.001 + 1e-5 * unit(random);
    x += 1e-3 * Vec3{unit(random), unit(random), unit(random)};
    x *= 0.052 / glm::length(x);
    if (i == 300) put_chain("0.053");
    if (i == 400) change(ChainSettings{.stiffness = 123.456789, .ticks = {.stiffness = 1.0 / 3.0}});
    if (i == 500) change(HandSwitch::kForceOff);
    if (i == 510) change(HandSwitch::kArm);
    if (i == 520) change(HandSwitch::kRestart);
    if (i % 250 == 249) recorder.event(stepper.next_number(), static_cast<std::uint64_t>(i), "key G\ndown");
    HandInput input{.time = t, .present = i % 400 < 380, .sample = {t - 1e-4, x, i % 2 == 0 ? 1U : 0U}};
    if (i % 97 == 96) input.sample.position.y = kNan;
    if (i % 3 == 0) input.sample.hand = 0.3 * x;
    if (i % 89 == 88) input.time = t - 1.0;
    made.push_back(stepper.step(input));
    recorder.step(input, made.back());
  }
  recorder.finish();
  return made;
}

std::string refusal(const std::string& file) {
  try {
    (void)read_recording(file);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    return error.what();
  }
  return "accepted";
}

ReplayVerdict play(const Recording& recording) {
  ReplaySource source(recording, chain_from);
  while (!source.done()) (void)source.step();
  return source.verdict();
}

class RecordingTest : public testing::Test {
 protected:
  TempFolder folder_;
  std::string file_ = folder_.path("run.txt").string();
};

TEST_F(RecordingTest, RepeatsARunBitForBit) {
  const auto made = record_run(file_, 1000);
  const Recording recording = read_recording(file_);
  EXPECT_TRUE(recording.ended);
  EXPECT_EQ(recording.lost, 0U);
  ASSERT_EQ(recording.steps.size(), 1000U);
  EXPECT_EQ(recording.chains, (std::vector<std::string>{"0.05", "0.053"}));
  ReplaySource source(recording, chain_from);
  double largest = 0.0;
  const AllocationGuard guard;
  for (const HandStep& expected : made) {
    ASSERT_FALSE(source.done());
    const HandStep step = source.step();
    ASSERT_EQ(step.number, expected.number);
    ASSERT_EQ(step.force, expected.force) << step.number;
    ASSERT_EQ(step.chain.proxies, expected.chain.proxies) << step.number;
    ASSERT_EQ(step.state, expected.state);
    ASSERT_EQ(step.buttons, expected.buttons);
    largest = std::max(largest, glm::length(step.force));
  }
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_GT(largest, 0.1) << "nothing was felt, so nothing was tried";
  EXPECT_TRUE(source.done());
  EXPECT_EQ(source.verdict().same, 1000U);
  EXPECT_EQ(source.verdict().differs, 0U);
  EXPECT_EQ(verdict_text(source.verdict(), recording), "identical: 1000 of 1000 steps");
}

TEST_F(RecordingTest, KeepsHeaderAndEvents) {
  record_run(file_, 600);
  const Recording recording = read_recording(file_);
  const RecordingHeader expected = header();
  EXPECT_EQ(recording.header.program, expected.program);
  EXPECT_EQ(recording.header.version, expected.version);
  EXPECT_EQ(recording.header.build, expected.build);
  EXPECT_EQ(recording.header.inputs, expected.inputs);
  EXPECT_EQ(recording.header.limits, expected.limits);
  EXPECT_EQ(recording.header.values,
            (std::vector<std::pair<std::string, std::string>>{
                {"mode", "streamline"}, {"seeds", "grid:8,8,8 of all"}, {"empty", ""}}));
  ASSERT_EQ(recording.events.size(), 2U);
  EXPECT_EQ(recording.events[1].step, 499U);
  EXPECT_EQ(recording.events[1].frame, 499U);
  EXPECT_EQ(recording.events[1].text, "key G down");
}

TEST_F(RecordingTest, KeepsEveryBitOfANumber) {
  const std::array numbers{
      0.1,       -0.0,  std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max(),
      1.0 / 3.0, 1e-300};
  {
    Recorder recorder(file_, header(), false);
    for (std::uint64_t i = 0; i < numbers.size(); ++i) {
      const HandInput input{
          .time = numbers[i], .present = true, .sample = {numbers[i], Vec3{numbers[i]}, 0xFFFFFFFF}};
      recorder.step(input, {.number = i});
    }
  }
  const Recording recording = read_recording(file_);
  ASSERT_EQ(recording.steps.size(), numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const HandInput& input = recording.steps[i].input;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(input.time), std::bit_cast<std::uint64_t>(numbers[i]));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(input.sample.position.z),
              std::bit_cast<std::uint64_t>(numbers[i]));
    EXPECT_EQ(input.sample.buttons, 0xFFFFFFFF);
  }
}

TEST_F(RecordingTest, TellsWhenFaultsBeganAndTicksOverran) {
  const auto made = record_run(file_, 300);
  std::vector<RecordedFault> faults;
  ForceCut before = ForceCut::kNone;
  for (const HandStep& step : made) {
    if (is_fault(step.cut) && step.cut != before) faults.push_back({step.number, step.cut});
    before = step.cut;
  }
  EXPECT_GT(faults.size(), 4U);
  EXPECT_EQ(read_recording(file_).faults, faults);
  const std::vector<Overrun> overruns{{7, 3, 2'000'000, 15'000}, {9, 1, 0, 1'100'000}};
  {
    Recorder recorder(file_, header(), true);
    for (const Overrun& overrun : overruns) recorder.overrun(overrun);
  }
  EXPECT_EQ(read_recording(file_).overruns, overruns);
}

TEST_F(RecordingTest, FindsTheBlockOfAChangedSample) {
  record_run(file_, 1000);
  Recording recording = read_recording(file_);
  double& z = recording.steps[700].input.sample.position.z;
  z = std::nextafter(z, 1.0);  // one bit of one sample
  const ReplayVerdict verdict = play(recording);
  EXPECT_EQ(verdict.same, 512U);
  EXPECT_EQ(verdict.differs, 768U);
  EXPECT_EQ(verdict_text(verdict, recording), "differs from the recording, first between steps 512 and 767");
}

TEST_F(RecordingTest, FindsAChangedSetting) {
  record_run(file_, 1000);
  Recording recording = read_recording(file_);
  for (RecordedChange& change : recording.changes) {
    if (auto* settings = std::get_if<ChainSettings>(&change.change)) settings->stiffness += 1e-13;
  }
  EXPECT_EQ(play(recording).same, 256U);
}

// Wherever a crash cuts the file: what is left is read up to the last whole line, or the header is missing.
TEST_F(RecordingTest, ReadsAFileThatWasCutOff) {
  record_run(file_, 600);
  const std::string whole = read_file(file_);
  const std::size_t begin = whole.find("begin\n") + 6;
  std::mt19937_64 random{2};
  for (int i = 0; i < 200; ++i) {
    const std::size_t length = random() % (whole.size() - 1);
    const std::string cut = folder_.write("cut.txt", whole.substr(0, length)).string();
    if (length < begin) {
      EXPECT_NE(refusal(cut), "accepted") << length;
      continue;
    }
    const Recording recording = read_recording(cut);
    EXPECT_FALSE(recording.ended);
    const ReplayVerdict verdict = play(recording);
    EXPECT_EQ(verdict.differs, 0U) << length;
    EXPECT_EQ(verdict.same, recording.hashes.empty() ? 0 : recording.hashes.back().steps);
    EXPECT_NE(verdict_text(verdict, recording).find("cut off"), std::string::npos);
  }
}

TEST_F(RecordingTest, NamesTheLineOfAnythingElse) {
  const std::string head = "palpate-recording 1\nbegin\n";
  const auto of = [&](const std::string& text) {
    const std::string line = refusal(folder_.write("bad.txt", text).string());
    const auto place = line.find("bad.txt: ");
    return place == std::string::npos ? line : line.substr(place + 9);
  };
  EXPECT_EQ(of(""), "is empty; expected a recording made with --record");
  EXPECT_EQ(of("# vtk DataFile\n"), "line 1: is no recording; expected a recording made with --record");
  EXPECT_EQ(of("palpate-recording 2\n"), "line 1: is of another format; expected format 1 of this version");
  EXPECT_EQ(of("palpate-recording 1\nprogram flow\n"),
            "ends within its header; expected a recording made with --record");
  EXPECT_EQ(of("palpate-recording 1\nlimits 1 1 -1 1 1 0 1 1 0 0 0 1 1 1 0 0 -1 0\n"),
            "line 2: limits that no device can have; expected positive numbers");
  EXPECT_EQ(of(head + "s 0 0.1 0.1 1 2\n"), "line 3: ends too early; expected a coordinate");
  EXPECT_EQ(of(head + "s 0 0.1 0.1 1 2 3 0 7\n"),
            "line 3: ends too early; expected a coordinate of the hand");
  EXPECT_EQ(of(head + "s 0 0.1 0.1 1 2 3 0 7 8 9 4\n"),
            "line 3: goes on with '4'; expected the end of the line");
  EXPECT_EQ(of(head + "s 0 0.1 0.1 1 up 3 0\n"), "line 3: 'up' cannot be read; expected a coordinate");
  EXPECT_EQ(of(head + "n -1 0.1\n"), "line 3: '-1' cannot be read; expected the number of a step");
  EXPECT_EQ(of(head + "n 99999999999999999999 0.1\n").substr(0, 30), "line 3: '99999999999999999999'");
  EXPECT_EQ(of(head + "n 5 0.1\nn 5 0.2\n"), "line 4: step 5; expected one from 6 on");
  EXPECT_EQ(of(head + "n 5 0.1\nswitch 5 arm\n"),
            "line 4: a change before step 5; expected one before step 6 or later");
  EXPECT_EQ(of(head + "switch 0 on\n").substr(0, 25), "line 3: 'on' is no switch");
  EXPECT_EQ(of(head + "settings 0 stiffness=200\n").substr(0, 32), "line 3: settings that no chain c");
  EXPECT_EQ(of(head + "hash 256 0\nhash 256 0\n").substr(0, 9), "line 4: a");
  EXPECT_EQ(of(head + "fault 0 jump\n").substr(0, 27), "line 3: 'jump' is no fault;");
  EXPECT_EQ(of(head + "overrun 0 1 2\n"), "line 3: ends too early; expected a time in nanoseconds");
  EXPECT_EQ(of("palpate-recording 1\nlimits 1 1 1 1 1\n"),
            "line 2: ends too early; expected eighteen numbers");
  EXPECT_EQ(of(head + "end 0\nend 0\n"), "line 4: a line after the end; expected nothing");
  EXPECT_EQ(of(head + "dance\n").substr(0, 24), "line 3: 'dance' is not k");
  EXPECT_NE(of(head + std::string(1U << 17U, 'x') + "\n").find("longer than"), std::string::npos);
}

TEST_F(RecordingTest, SurvivesDamagedFiles) {
  record_run(file_, 300);
  const std::string whole = read_file(file_);
  std::mt19937_64 random{23};
  int accepted = 0;
  for (int i = 0; i < 500; ++i) {
    std::string damaged = whole;
    char& byte = damaged[random() % damaged.size()];
    byte = "\n 09.-en\xFF"[random() % 9];
    try {
      const Recording recording = read_recording(folder_.write("bad.txt", damaged).string());
      ReplaySource source(recording, [](const std::string&) { return sphere_chain(0.05); });
      while (!source.done()) {
        ASSERT_TRUE(std::isfinite(source.due()));
        ASSERT_TRUE(is_finite(source.step().force));
      }
      ++accepted;
    } catch (const Error& error) {
      ASSERT_EQ(error.code(), ExitCode::kBadInput);
    }
  }
  EXPECT_GT(accepted, 50) << "digits changed alone leave a file that can be read";
}

TEST_F(RecordingTest, SaysWhenEntriesWereLost) {
  record_run(file_, 5000, 4);
  const Recording recording = read_recording(file_);
  ASSERT_GT(recording.lost, 0U);
  EXPECT_TRUE(recording.ended);
  EXPECT_NE(verdict_text(play(recording), recording).find("cannot be repeated exactly"), std::string::npos);
}

TEST_F(RecordingTest, RefusesToOverwriteAndSaysWhenTheDiskIsFull) {
  folder_.write("run.txt", "mine");
  const auto code = [&](const std::string& file, bool overwrite) {
    try {
      Recorder(file, header(), overwrite).finish();
    } catch (const Error& error) {
      return error.code();
    }
    return ExitCode::kDone;
  };
  EXPECT_EQ(code(file_, false), ExitCode::kUsage);
  EXPECT_EQ(read_file(file_), "mine");
  {
    const Recorder recorder(file_, header(), true);
    EXPECT_EQ(read_file(file_ + "~"), "mine") << "a kill now would leave it";
  }
  EXPECT_TRUE(read_recording(file_).ended);
  EXPECT_FALSE(std::filesystem::exists(file_ + "~"));
  const std::string input = folder_.write("input.vtk", "mine").string();
  keep_from_outputs(std::vector<std::filesystem::path>{input});
  EXPECT_EQ(code(input, true), ExitCode::kUsage);
  EXPECT_EQ(read_file(input), "mine");
  EXPECT_EQ(code(folder_.path("missing/run.txt").string(), false), ExitCode::kWorkFailed);
  EXPECT_EQ(code("/dev/full", true), ExitCode::kWorkFailed);
}

}  // namespace
}  // namespace palpate::test
