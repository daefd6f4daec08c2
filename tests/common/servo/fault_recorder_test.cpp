// What is saved when something goes wrong, and whether it can be played. Runs are stepped here, without a
// clock; only the writer's thread is waited for.

#include "common/servo/fault_recorder.h"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "common/servo/replay_source.h"
#include "tests/common/servo/sphere_drag.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kRate = 200.0;  // [Hz]: 2000 steps are kept, 50 of them after the fault
constexpr std::uint64_t kKept = 2000, kAfter = 50;

/// A run that is stepped by hand.
class SteppedRun {
 public:
  SteppedRun(const std::filesystem::path& folder, const DeviceLimits& limits)
      : faults(folder, {.program = "test", .limits = limits}, kRate), stepper_(nullptr, limits) {
    put_chain(0.05);
  }

  void put_chain(double radius) {
    faults.change(stepper_.next_number(), ChainChange{faults.describe_chain(std::to_string(radius))});
    (void)stepper_.exchange_chain(sphere_chain(radius));
    faults.change(stepper_.next_number(), ChainSettings{});
  }
  template <typename What>
  void change(const What& what) {
    faults.change(stepper_.next_number(), what);
    stepper_.apply(what);
  }
  /// Goes round the sphere, a little outside of it.
  HandStep go(int steps) {
    HandStep last;
    for (int i = 0; i < steps; ++i) {
      const double angle = 0.002 * static_cast<double>(stepper_.next_number());
      last = step(true, 0.052 * Vec3{std::cos(angle), std::sin(angle), 0.0});
    }
    return last;
  }
  void lift(int steps) {
    for (int i = 0; i < steps; ++i) step(false, Vec3{0.0});
  }
  HandStep step(bool present, const Vec3& x) {
    const double t = static_cast<double>(stepper_.next_number()) / kRate;
    const HandInput input{.time = t, .present = present, .sample = {t, x, 0}};
    const HandStep made = stepper_.step(input);
    faults.step(input, made);
    return made;
  }
  [[nodiscard]] std::uint64_t next() const { return stepper_.next_number(); }

  FaultRecorder faults;

 private:
  HandStepper stepper_;
};

bool wait_for(const std::function<bool()>& happened) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (!happened()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

ReplayVerdict play(const Recording& recording) {
  ReplaySource source(recording, [](const std::string& radius) { return sphere_chain(std::stod(radius)); });
  while (!source.done()) (void)source.step();
  return source.verdict();
}

class FaultRecorderTest : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path file(int n) const {
    return folder_.path("faults") / ("test-fault-" + std::to_string(n) + ".rec");
  }
  [[nodiscard]] Recording read(int n) const { return read_recording(file(n).string()); }

  TempFolder folder_;
  DeviceLimits limits_;
};

TEST_F(FaultRecorderTest, SavesWhatLedToAFaultAndPlaysItBitForBit) {
  std::uint64_t fault = 0;
  {
    SteppedRun run(folder_.path("faults"), limits_);
    run.go(300);
    run.lift(2);
    const std::uint64_t forgotten = run.next() - 2;
    run.go(300);
    run.change(ChainSettings{.stiffness = 317.0});
    run.go(100);
    run.put_chain(0.053);
    run.go(100);
    fault = run.step(true, {kNan, 0.0, 0.0}).number;
    run.go(200);
    EXPECT_EQ(run.faults.faults(), 1U);
    ASSERT_TRUE(wait_for([&] { return std::filesystem::exists(file(1)); }));
    const Recording recording = read(1);
    EXPECT_TRUE(recording.ended);
    EXPECT_EQ(recording.steps.front().number, forgotten);
    EXPECT_EQ(recording.steps.back().number, fault + kAfter);
    EXPECT_EQ(recording.chains.size(), 2U);
    EXPECT_EQ(recording.faults, (std::vector<RecordedFault>{{fault, ForceCut::kNotFinite}}));
    EXPECT_EQ(play(recording).same, recording.steps.size());
    ASSERT_TRUE(wait_for([&] {
      const auto news = run.faults.news();
      return news && news->find(file(1).string()) != std::string::npos;
    }));
    EXPECT_EQ(run.faults.news(), std::nullopt) << "once";
  }
  EXPECT_FALSE(std::filesystem::exists(file(2)));
}

TEST_F(FaultRecorderTest, KnowsWhatWasInPlaceBeforeItsMemoryBegins) {
  {
    SteppedRun run(folder_.path("faults"), limits_);
    run.put_chain(0.0515);
    run.change(ChainSettings{.stiffness = 250.0});
    run.change(HandSwitch::kForceOff);
    run.go(2500);
    run.lift(1);
    run.go(1000);
    run.change(HandSwitch::kArm);
    run.go(600);
    run.step(true, {0.0, kNan, 0.0});
  }  // cut short: saved at the end
  const Recording recording = read(1);
  EXPECT_EQ(recording.steps.front().number, 2500U);
  EXPECT_EQ(recording.chains, std::vector<std::string>{std::to_string(0.0515)});
  ASSERT_GE(recording.changes.size(), 4U);
  EXPECT_EQ(std::get<ChainSettings>(recording.changes[1].change).stiffness, 250.0);
  EXPECT_EQ(std::get<HandSwitch>(recording.changes[2].change), HandSwitch::kForceOff);
  EXPECT_EQ(play(recording).same, recording.steps.size());
}

TEST_F(FaultRecorderTest, KeepsTheLatestSettingsOfASliderThatIsNeverAtRest) {
  constexpr int kEdits = 1500;  // more than are kept
  {
    SteppedRun run(folder_.path("faults"), limits_);
    for (int i = 0; i < kEdits; ++i) {
      run.change(ChainSettings{.stiffness = 100.0 + i});
      if (i == 1000) {
        run.lift(1);
      } else {
        run.go(1);
      }
    }
    run.step(true, {kNan, 0.0, 0.0});
  }
  const Recording recording = read(1);
  EXPECT_EQ(recording.steps.front().number, 1000U);
  EXPECT_EQ(std::get<ChainSettings>(recording.changes[1].change).stiffness, 1100.0);
  EXPECT_EQ(std::get<ChainSettings>(recording.changes.back().change).stiffness, 99.0 + kEdits);
  EXPECT_EQ(play(recording).same, recording.steps.size());
}

TEST_F(FaultRecorderTest, ComparesNothingWhereItBeginsInTheMidst) {
  {
    SteppedRun run(folder_.path("faults"), limits_);
    run.go(5000);
    run.step(true, {kNan, 0.0, 0.0});
  }
  const Recording recording = read(1);
  EXPECT_EQ(recording.steps.size(), kKept);
  EXPECT_EQ(recording.steps.back().number, 5000U);
  EXPECT_TRUE(recording.hashes.empty());
  EXPECT_EQ(recording.faults.size(), 1U);
  EXPECT_EQ(play(recording).differs, 0U);
}

TEST_F(FaultRecorderTest, ALatchHoldsIntoTheNextMemory) {
  limits_.velocity_gate = 1.0;
  {
    SteppedRun run(folder_.path("faults"), limits_);
    run.lift(1);
    run.go(100);
    run.step(true, {0.5, 0.5, 0.5});  // too fast
    run.go(100);
    ASSERT_TRUE(wait_for([&] { return std::filesystem::exists(file(1)); }));
    run.lift(1);
    EXPECT_EQ(run.go(100).cut, ForceCut::kTooFast) << "still latched";
    run.change(HandSwitch::kArm);
    run.go(100);
    run.step(true, {-0.5, 0.5, 0.5});
    EXPECT_EQ(run.faults.faults(), 2U);
  }
  for (const int n : {1, 2}) {
    const Recording recording = read(n);
    EXPECT_EQ(play(recording).same, recording.steps.size()) << n;
    EXPECT_GT(recording.steps.size(), 100U);
  }
}

TEST_F(FaultRecorderTest, SavesAStallAndStopsBeforeTheDiskIsFull) {
  limits_.latch_faults = true;  // it shows force
  SteppedRun run(folder_.path("faults"), limits_);
  run.go(10);
  for (int n = 1; n <= FaultRecorder::kMostFiles; ++n) {
    run.faults.stalled();
    run.go(60);
    ASSERT_TRUE(wait_for([&] { return std::filesystem::exists(file(n)) && run.faults.news(); })) << n;
  }
  run.faults.stalled();
  run.go(60);
  EXPECT_EQ(run.faults.faults(), static_cast<std::uint64_t>(FaultRecorder::kMostFiles) + 1);
  EXPECT_FALSE(std::filesystem::exists(file(FaultRecorder::kMostFiles + 1)));
}

// Nobody is hurt by a mouse on a busy machine; that a sample is no number is another matter.
TEST_F(FaultRecorderTest, TakesABusyMachineForNoFaultOfAMouse) {
  SteppedRun run(folder_.path("faults"), limits_);
  run.go(10);
  run.faults.stalled();
  run.go(60);
  run.change(HandSwitch::kRestart);
  run.go(60);
  EXPECT_EQ(run.faults.faults(), 0U);
  run.step(true, {kNan, 0.0, 0.0});
  EXPECT_EQ(run.faults.faults(), 1U);
}

// Of all runs of a program the latest files stay; those of others are theirs.
TEST_F(FaultRecorderTest, KeepsTheLatestFilesOfAllRuns) {
  constexpr int kBefore = 30;
  std::filesystem::create_directories(folder_.path("faults"));
  for (int n = 1; n <= kBefore; ++n) std::ofstream(file(n)) << n;
  const auto theirs = {"faults/other-fault-1.rec", "faults/notes.txt", "faults/test-fault-x.rec"};
  for (const char* each : theirs) std::ofstream(folder_.path(each)) << "theirs";
  limits_.latch_faults = true;
  {
    SteppedRun run(folder_.path("faults"), limits_);
    run.faults.stalled();
    run.go(60);
  }
  const int kept = static_cast<int>(FaultRecorder::kKept);
  EXPECT_TRUE(std::filesystem::exists(file(kBefore + 1))) << "after the last one, not in a gap";
  for (int n = 1; n <= kBefore + 1; ++n)
    EXPECT_EQ(std::filesystem::exists(file(n)), n > kBefore + 1 - kept) << n;
  for (const char* each : theirs) EXPECT_TRUE(std::filesystem::exists(folder_.path(each))) << each;
}

TEST_F(FaultRecorderTest, SaysWhereNothingCanBeWritten) {
  folder_.write("faults", "a file where the folder should be");
  SteppedRun run(folder_.path("faults"), limits_);
  run.step(true, {kNan, 0.0, 0.0});
  run.go(60);
  std::optional<std::string> news;
  ASSERT_TRUE(wait_for([&] { return (news = run.faults.news()).has_value(); }));
  EXPECT_NE(news->find("could not be saved"), std::string::npos) << *news;
}

TEST_F(FaultRecorderTest, AllocatesNothingInAStep) {
  SteppedRun run(folder_.path("faults"), limits_);
  const AllocationGuard guard;
  for (int i = 0; i < 20; ++i) {
    run.go(300);
    run.change(ChainSettings{.stiffness = 100.0 + i});
    run.step(true, {kNan, 0.0, 0.0});
  }
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace palpate::test
