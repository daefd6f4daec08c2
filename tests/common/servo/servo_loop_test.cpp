// The servo's thread: what goes in and out of it. No time is asserted; every wait is for an event, and gives
// up after half a minute. Run under ThreadSanitizer too.

#include "common/servo/servo_loop.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/last_acts.h"
#include "common/device/mouse_device.h"
#include "tests/common/servo/sphere_drag.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

constexpr double kRadius = 0.05;  // [m]
const Vec3 kNear{0.0, 0.0, 0.052};
constexpr double kPull = -200.0 * 0.002;  // [N] of the default stiffness

/// Rests at kNear; remembers what it was told.
class RestingDevice final : public Device {
 public:
  bool read(double now, DeviceSample& sample) noexcept override {
    for (int i = 0; stall && i < 3000 && stops == 0; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    stall = false;
    sample = {now, kNear, 0};
    return true;
  }
  void command(const Vec3& force) noexcept override { shown = force.z; }
  void emergency_stop() noexcept override {
    shown = 0.0;
    ++stops;
  }
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }

  std::atomic<double> shown{7.0};
  std::atomic<int> stops{0};
  std::atomic<bool> stall{false};

 private:
  DeviceLimits limits_;
};

bool wait_for(const std::function<bool()>& happened) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (!happened()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

/// Waits until a state is as it should be.
bool wait_for(ServoLoop& servo, const std::function<bool(const ServoState&)>& as_it_should) {
  ServoState state;
  return wait_for([&] { return servo.read(state) && as_it_should(state); });
}

bool near(double force, double expected) { return std::abs(force - expected) < 1e-9; }

TEST(ServoLoop, ShowsTheForceAndSendsZeroAtTheEnd) {
  RestingDevice device;
  {
    ServoLoop servo(device, sphere_chain(kRadius), "");
    EXPECT_TRUE(wait_for([&] { return near(device.shown, kPull); }));
    EXPECT_TRUE(wait_for(servo, [](const ServoState& s) {
      return s.hand.state == HoldState::kHeld && near(s.hand.force.z, kPull) && s.statistics.ticks > 10 &&
             s.statistics.lateness.count() == s.statistics.ticks;
    }));
  }
  EXPECT_EQ(device.shown, 0.0);
}

// As where Ctrl-C meets a window that does not come round: the loop is at work, and nobody will destroy it.
TEST(ServoLoop, LastActsTakeTheForceAwayAndEndTheRecording) {
  const TempFolder folder;
  const auto file = folder.path("run.txt");
  RestingDevice device;
  Recorder recorder(file, {.program = "flow"}, false);
  {
    ServoLoop servo(device, sphere_chain(kRadius), "", {}, &recorder);
    ASSERT_TRUE(wait_for([&] { return near(device.shown, kPull); }));
    run_last_acts();
    EXPECT_EQ(device.shown, 0.0);
    EXPECT_EQ(device.stops, 1);
    const std::uint64_t then = servo.next_step();
    EXPECT_TRUE(wait_for([&] { return servo.next_step() > then + 10; })) << "it goes on, without force";
    EXPECT_EQ(device.shown, 0.0);
  }
  const Recording ended = read_recording(file.string());
  EXPECT_TRUE(ended.ended);
  EXPECT_GT(ended.steps.size(), 0U);
  recorder.finish();
  EXPECT_EQ(read_recording(file.string()).steps.size(), ended.steps.size()) << "it had ended";
}

TEST(ServoLoop, HandsOutEveryStepInOrder) {
  RestingDevice device;
  ServoLoop servo(device, sphere_chain(kRadius), "", {.rate = 2000.0});
  std::uint64_t expected = 0;
  EXPECT_TRUE(wait_for([&] {
    for (HandStep step; servo.pop_step(step); ++expected) EXPECT_EQ(step.number, expected);
    return expected > 200;
  }));
  EXPECT_GE(servo.next_step(), expected);
}

TEST(ServoLoop, TakesSettingsAndSwitches) {
  RestingDevice device;
  ServoLoop servo(device, sphere_chain(kRadius), "");
  EXPECT_FALSE(servo.set_settings({.stiffness = -1.0}));
  EXPECT_TRUE(servo.set_settings({.stiffness = 100.0}));
  EXPECT_TRUE(wait_for([&] { return near(device.shown, 0.5 * kPull); }));
  servo.force_off();
  EXPECT_TRUE(wait_for(servo, [](const ServoState& s) {
    return !s.armed && s.hand.cut == ForceCut::kSwitchedOff && s.hand.force == Vec3{0.0};
  }));
  servo.arm();
  EXPECT_TRUE(wait_for([&] { return near(device.shown, 0.5 * kPull); }));
  servo.force_off();
  servo.arm();
  servo.force_off();
  EXPECT_TRUE(wait_for(servo, [](const ServoState& s) { return !s.armed; })) << "off wins";
}

/// Counts chains that live, and refuses to be deleted by another thread than the one that made it.
class Counted final : public Constraint {
 public:
  explicit Counted(std::atomic<int>& living) : living_(living), maker_(std::this_thread::get_id()) {
    ++living_;
  }
  ~Counted() override {
    EXPECT_EQ(std::this_thread::get_id(), maker_);
    --living_;
  }
  void apply(const ChainSettings& /*settings*/) noexcept override {}
  void reset() noexcept override {}
  void update(const Vec3& probe, const UpdateBudget& /*budget*/, LinkUpdate& link) noexcept override {
    link.proxy = probe;
  }

 private:
  std::atomic<int>& living_;
  std::thread::id maker_;
};

TEST(ServoLoop, NeitherDeletesNorLosesAChainThatItIsGiven) {
  std::atomic<int> living{0};
  RestingDevice device;
  const auto make = [&living] {
    std::vector<std::unique_ptr<Constraint>> links;
    links.push_back(std::make_unique<Counted>(living));
    return std::make_unique<ProxyChain>(std::move(links), ChainSettings{});
  };
  {
    ServoLoop servo(device, make(), "", {.rate = 10'000.0});
    for (int i = 0; i < 300; ++i) {
      servo.swap_chain(make(), "");
      if (i % 3 == 0) std::this_thread::sleep_for(std::chrono::microseconds(300));
      EXPECT_LE(living, 4);
    }
    EXPECT_TRUE(wait_for([&] {
      servo.collect_retired();
      return living == 1;
    })) << "only the one in use is left";
    servo.swap_chain(nullptr, "");
    EXPECT_TRUE(wait_for([&] {
      servo.collect_retired();
      return living == 0;
    }));
    servo.swap_chain(make(), "");
  }
  EXPECT_EQ(living, 0);
}

TEST(ServoLoop, StartsFromZeroWithAnotherChain) {
  RestingDevice device;
  ServoLoop servo(device, sphere_chain(kRadius), "");
  ASSERT_TRUE(wait_for([&] { return near(device.shown, kPull); }));
  servo.swap_chain(sphere_chain(0.053), "");
  std::vector<HandStep> steps;
  EXPECT_TRUE(wait_for([&] {
    for (HandStep step; servo.pop_step(step);) steps.push_back(step);
    return near(device.shown, 0.2);
  }));
  const auto first = std::find_if(steps.begin() + 1, steps.end(),
                                  [](const HandStep& s) { return s.chain.proxies[0].z > 0.0525; });
  ASSERT_NE(first, steps.end());
  EXPECT_EQ(first->cut, ForceCut::kStart);
  EXPECT_EQ(first->force, Vec3(0.0));
}

TEST(ServoLoop, StopsTheDeviceWhenItStallsAndStartsFromZeroAfterwards) {
  RestingDevice device;
  ServoLoop servo(device, sphere_chain(kRadius), "");
  ASSERT_TRUE(wait_for([&] { return near(device.shown, kPull); }));
  const int stops = device.stops;  // a busy machine may have stalled it already
  device.stops = 0;
  HandStep step;
  while (servo.pop_step(step)) {
  }
  device.stall = true;
  EXPECT_TRUE(wait_for(servo, [&](const ServoState& s) {
    return s.statistics.stalls > static_cast<std::uint64_t>(stops) && near(s.hand.force.z, kPull);
  }));
  bool restarted = false;
  while (servo.pop_step(step))
    restarted = restarted || (step.cut == ForceCut::kStart && step.force == Vec3{0.0});
  EXPECT_TRUE(restarted);
  EXPECT_GE(device.stops, 1);
}

/// Counts what the servo's thread allocates from its tenth tick on.
class AllocationDevice final : public Device {
 public:
  bool read(double now, DeviceSample& sample) noexcept override {
    if (++reads == 10) guard_.emplace();
    if (guard_) allocations = guard_->count();
    sample = {now, kNear, 0};
    return reads % 50 != 0;
  }
  void command(const Vec3& /*force*/) noexcept override {}
  void emergency_stop() noexcept override {}
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }

  std::atomic<int> reads{0};
  std::atomic<std::size_t> allocations{0};

 private:
  DeviceLimits limits_;
  std::optional<AllocationGuard> guard_;
};

TEST(ServoLoop, AllocatesNothingInATick) {
  const TempFolder folder;
  Recorder recorder(folder.path("run.txt"), {}, false);
  AllocationDevice device;
  ServoLoop servo(device, sphere_chain(kRadius), "", {.rate = 5000.0}, &recorder);
  ASSERT_TRUE(wait_for([&] { return device.reads > 20; }));
  for (int i = 0; i < 50; ++i) {
    servo.swap_chain(sphere_chain(kRadius), "another");
    servo.set_settings({.stiffness = 100.0 + i});
    servo.force_off();
    servo.arm();
    const int until = device.reads + 3;
    ASSERT_TRUE(wait_for([&] { return device.reads >= until; }));
  }
  EXPECT_EQ(device.allocations, 0U);
}

/// Takes long at times, and once gives what is no position.
class ClumsyDevice final : public Device {
 public:
  bool read(double now, DeviceSample& sample) noexcept override {
    ++reads_;
    if (reads_ % 40 == 39) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    sample = {now, reads_ == 200 ? Vec3{std::nan("")} : kNear, 0};
    return reads_ > 100;
  }
  void command(const Vec3& /*force*/) noexcept override {}
  void emergency_stop() noexcept override {}
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }

 private:
  DeviceLimits limits_;
  int reads_ = 0;
};

TEST(ServoLoop, RecordsOverrunsAndSavesTheSecondsBeforeAFault) {
  const TempFolder folder;
  const std::string file = folder.path("run.txt").string();
  ServoStatistics statistics;
  {
    Recorder recorder(file, {.program = "test"}, false);
    FaultRecorder faults(folder.path("faults"), {.program = "test"}, 1000.0);
    ClumsyDevice device;
    {
      ServoLoop servo(device, sphere_chain(kRadius), "0.05", {}, &recorder, &faults);
      EXPECT_TRUE(wait_for(servo, [&](const ServoState& s) {
        statistics = s.statistics;
        return s.hand.number > 300;
      }));
    }
    recorder.finish();
    EXPECT_EQ(recorder.lost(), 0U);
  }
  EXPECT_EQ(statistics.faults, 1U);
  EXPECT_GT(statistics.overruns, 4U);
  EXPECT_GE(statistics.skipped, statistics.overruns);
  const Recording run = read_recording(file);
  EXPECT_GE(run.overruns.size(), statistics.overruns);
  EXPECT_EQ(run.faults, (std::vector<RecordedFault>{{199, ForceCut::kNotFinite}}));
  const Recording fault = read_recording(folder.path("faults/test-fault-1.rec").string());
  EXPECT_EQ(fault.faults, run.faults);
  ReplaySource replay(fault, [](const std::string& radius) { return sphere_chain(std::stod(radius)); });
  while (!replay.done()) (void)replay.step();
  EXPECT_EQ(replay.verdict().same, fault.steps.size());
}

TEST(ServoLoop, RefusesAnAbsurdRate) {
  RestingDevice device;
  for (const double rate : {99.9, 10'001.0, 0.0, -1000.0, std::nan("")}) {
    EXPECT_THROW(check_servo_rate(rate), Error) << rate;
  }
  EXPECT_NO_THROW(check_servo_rate(100.0));
  EXPECT_NO_THROW(check_servo_rate(10'000.0));
  EXPECT_THROW(ServoLoop(device, nullptr, "", {.rate = 1.0}), Error);
  EXPECT_THROW(ServoLoop(device, nullptr, "", {.rate = std::nan("")}), Error);
}

// A live run with everything that a window does, recorded; then repeated without a clock, and with one.
TEST(ServoLoop, RecordsARunThatRepeatsBitForBit) {
  const TempFolder folder;
  const std::string file = folder.path("run.txt").string();
  std::vector<HandStep> lived;
  {
    Recorder recorder(file, {.program = "test"}, false);
    MouseDevice mouse;
    {
      ServoLoop servo(mouse, sphere_chain(kRadius), "0.05", {}, &recorder);
      const auto drain = [&] {
        for (HandStep step; servo.pop_step(step);) lived.push_back(step);
      };
      for (int frame = 0; frame < 40; ++frame) {
        const double t = 0.016 * frame;
        const Vec3 x{0.02 * std::sin(t), 0.0, 0.048};
        if (frame == 2) mouse.grab(t, x, 0);
        if (frame == 35) mouse.let_go();
        mouse.move(t, x, frame % 8 == 0 ? 1U : 0U);
        if (frame == 10) servo.set_settings({.stiffness = 321.0});
        if (frame == 15) servo.swap_chain(sphere_chain(0.047), "0.047");
        if (frame == 20) servo.force_off();
        if (frame == 22) servo.arm();
        recorder.event(servo.next_step(), static_cast<std::uint64_t>(frame), "frame");
        const std::uint64_t until = servo.next_step() + 12;
        ASSERT_TRUE(wait_for([&] { return servo.next_step() >= until; }));
        drain();
      }
    }
    recorder.finish();
    EXPECT_EQ(recorder.lost(), 0U);
  }
  const auto make_chain = [](const std::string& description) { return sphere_chain(std::stod(description)); };
  const Recording recording = read_recording(file);
  EXPECT_EQ(recording.chains.size(), 2U);
  EXPECT_EQ(recording.events.size(), 40U);
  ReplaySource headless(recording, make_chain);
  double largest = 0.0;
  for (const HandStep& expected : lived) {
    ASSERT_FALSE(headless.done());
    const HandStep step = headless.step();
    ASSERT_EQ(step.number, expected.number);
    ASSERT_EQ(step.force, expected.force);
    ASSERT_EQ(step.chain.proxies, expected.chain.proxies);
    largest = std::max(largest, glm::length(step.force));
  }
  EXPECT_GT(largest, 0.1);
  while (!headless.done()) (void)headless.step();
  EXPECT_EQ(headless.verdict().same, recording.steps.size()) << verdict_text(headless.verdict(), recording);

  ReplaySource source(recording, make_chain);
  ServoLoop servo(source);
  ServoState state;
  std::size_t seen = 0;
  ASSERT_TRUE(wait_for([&] {
    for (HandStep step; servo.pop_step(step); ++seen) {
      if (seen < lived.size()) {
        EXPECT_EQ(step.force, lived[seen].force);
      }
    }
    return servo.read(state) && state.replay_done;
  }));
  EXPECT_EQ(state.replay.same, recording.steps.size());
  EXPECT_EQ(state.replay.differs, 0U);
}

}  // namespace
}  // namespace palpate::test
