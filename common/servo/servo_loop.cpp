#include "common/servo/servo_loop.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/text.h"
#include "common/servo/real_time.h"
#include "common/servo/tick_pace.h"

namespace palpate {
namespace {

constexpr int kWatchdogPriority = 81;  // above the servo: it must run when the servo spins

constexpr int kServoPriority = 80;      // below the watchdog's, above everything that has none
constexpr int kLongestLetGo = 50;       // [ms]
constexpr int kMostReplayedATick = 16;  // a replay that fell behind catches up without holding the processor

}  // namespace

Watchdog::Watchdog(Device& device, std::int64_t limit_ns)
    : device_(device), limit_(limit_ns), thread_([this](const std::stop_token& stop) { watch(stop); }) {}

Watchdog::~Watchdog() = default;

void Watchdog::watch(const std::stop_token& stop) {
  request_real_time_priority(kWatchdogPriority);
  std::int64_t reported = 0;
  std::unique_lock lock(sleeping_);
  while (!wake_.wait_for(lock, stop, std::chrono::nanoseconds(limit_ / 4), [] { return false; })) {
    if (stop.stop_requested()) return;
    const std::int64_t last = beat_.load(std::memory_order_acquire);
    if (last == 0 || last == reported || monotonic_ns() - last <= limit_) continue;
    device_.emergency_stop();
    reported = last;
    stalls_.fetch_add(1, std::memory_order_release);
  }
}

ServoLoop::ServoLoop(Device& device, std::unique_ptr<ProxyChain> chain, const std::string& description,
                     const ServoOptions& options, Recorder* recorder, FaultRecorder* faults)
    : path_(options.path_capacity),
      device_(&device),
      recorder_(recorder),
      faults_(faults),
      stepper_(nullptr, device.limits()),
      slept_(options.slept),
      slept_before_(slept_()) {
  PALPATE_CHECK(device.limits().valid());
  // The first chain too comes in by hand-over, so that it is recorded as any other.
  swap_chain(std::move(chain), description);
  take_chain();
  collect_retired();
  start(options);
}

ServoLoop::ServoLoop(ReplaySource& replay, const ServoOptions& options)
    : path_(options.path_capacity),
      replay_(&replay),
      stepper_(nullptr, replay.recording().header.limits),
      slept_(options.slept),
      slept_before_(slept_()) {
  start(options);
}

ServoLoop::~ServoLoop() {
  last_act_.reset();
  if (thread_.joinable()) {
    thread_.request_stop();
    thread_.join();
  }
  watchdog_.reset();
  collect_retired();
  delete incoming_.exchange(nullptr);
}

void check_servo_rate(double rate) {
  if (rate >= ServoOptions::kLeastRate && rate <= ServoOptions::kMostRate) return;
  throw usage_error("a servo rate of " + short_number(rate) + " Hz; give one from " +
                    short_number(ServoOptions::kLeastRate) + " to " + short_number(ServoOptions::kMostRate));
}

void ServoLoop::start(const ServoOptions& options) {
  check_servo_rate(options.rate);
  now_.rate = options.rate;
  stops_seen_ = program_stops();
  period_ = std::llround(1e9 / options.rate);
  if (device_ != nullptr) watchdog_.emplace(*device_);
  thread_ = std::jthread(
      [this, real_time = options.real_time](const std::stop_token& stop) { run(stop, real_time); });
  if (device_ != nullptr) last_act_.emplace([this] { let_go(); });
}

// A tick at work may have missed the switch: the one after it has not. One that hangs is the watchdog's case.
void ServoLoop::let_go() {
  force_off();
  const std::uint64_t before = next_step();
  for (int i = 0; i < kLongestLetGo && next_step() < before + 2; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  device_->emergency_stop();
}

bool ServoLoop::set_settings(const ChainSettings& settings) noexcept {
  if (!settings.valid()) return false;
  settings_.write(settings);
  return true;
}

void ServoLoop::swap_chain(std::unique_ptr<ProxyChain> chain, const std::string& description) {
  collect_retired();
  auto next = std::make_unique<Handover>();
  next->chain = std::move(chain);
  if (recorder_ != nullptr) next->recorded = recorder_->describe_chain(description);
  if (faults_ != nullptr) next->kept = faults_->describe_chain(description);
  delete incoming_.exchange(next.release(), std::memory_order_acq_rel);
}

void ServoLoop::collect_retired() noexcept {
  Handover* retired = nullptr;
  while (retired_.pop(retired)) delete retired;
}

void ServoLoop::run(const std::stop_token& stop, bool real_time) noexcept {
  if (real_time) {
    now_.real_time = {.real_time_priority = request_real_time_priority(kServoPriority),
                      .memory_locked = lock_memory()};
  }
  ServoStatistics& statistics = now_.statistics;
  const Bell* const bell = device_ != nullptr ? device_->bell() : nullptr;
  const auto rang = [bell] { return bell != nullptr ? bell->rang() : Bell::Rang(); };
  TickPace pace(period_, monotonic_ns());
  while (!stop.stop_requested()) {
    const TickPace::Wait wait = pace.next();
    sleep_until_ns(wait.from);
    if (const Bell::Rang sample = rang(); pace.awaits(sample)) bell->wait(sample.count, wait.until);
    const std::int64_t due = pace.began(rang()), woken = monotonic_ns();
    if (watchdog_) watchdog_->beat(woken);
    const std::int64_t late = std::max(std::int64_t{0}, woken - due);
    now_.late = 2 * late > period_;
    statistics.late += now_.late ? 1 : 0;
    statistics.lateness.add(late);
    ++statistics.ticks;

    const std::int64_t used = thread_cpu_ns();
    if (replay_ != nullptr) {
      play(1e-9 * static_cast<double>(woken));
    } else {
      tick(1e-9 * static_cast<double>(woken));
    }
    const std::int64_t update = thread_cpu_ns() - used;
    statistics.update.add(update);
    state_.write(now_);

    if (const std::int64_t passed = pace.ended(monotonic_ns()); passed > 0) {
      statistics.skipped += static_cast<std::uint64_t>(passed);
      overran({.step = now_.hand.number,
               .skipped = static_cast<std::uint64_t>(passed),
               .late = late,
               .used = update});
    }
  }
  if (device_ != nullptr) device_->command(Vec3{0.0});
}

void ServoLoop::tick(double now) noexcept {
  take_changes();
  HandInput input{.time = now};
  input.present = device_->read(now, input.sample);
  const HandStep step = stepper_.step(input);
  device_->command(step.force);
  if (recorder_ != nullptr) recorder_->step(input, step);
  if (faults_ != nullptr) faults_->step(input, step);
  now_.armed = stepper_.armed();
  publish(step);
}

void ServoLoop::play(double now) noexcept {
  if (replay_start_ < 0.0) replay_start_ = now;
  for (int i = 0; i < kMostReplayedATick && !replay_->done() && replay_start_ + replay_->due() <= now; ++i) {
    publish(replay_->step());
  }
  now_.replay = replay_->verdict();
  now_.replay_done = replay_->done();
}

void ServoLoop::publish(const HandStep& step) noexcept {
  if (is_fault(step.cut) && step.cut != now_.hand.cut) ++now_.statistics.faults;
  now_.hand = step;
  (void)path_.push(step);
  now_.path_dropped = path_.dropped();
  next_step_.store(step.number + 1, std::memory_order_release);
}

void ServoLoop::take_changes() noexcept {
  if (const std::uint64_t stalls = watchdog_->stalls(); stalls != stalls_seen_) {
    now_.statistics.stalls = stalls_seen_ = stalls;
    if (faults_ != nullptr) faults_->stalled();
    apply(HandSwitch::kRestart);
  }
  stop_after_sleep();
  take_chain();
  if (ChainSettings settings; settings_.read(settings)) {
    stepper_.apply(settings);
    record(settings);
  }
  if (const auto arm = arm_requests_.load(std::memory_order_acquire); arm != arm_seen_) {
    arm_seen_ = arm;
    apply(HandSwitch::kArm);
  }
  if (const auto off = off_requests_.load(std::memory_order_acquire); off != off_seen_) {
    off_seen_ = off;
    apply(HandSwitch::kForceOff);
  }
}

/// Nobody may lean on an arm that wakes up.
void ServoLoop::stop_after_sleep() noexcept {
  constexpr std::int64_t kAsleep = 10'000'000;  // [ns] both clocks are not read at once
  const std::int64_t slept = slept_();
  const std::uint64_t stops = program_stops();
  const bool woken = slept - slept_before_ > kAsleep || stops != stops_seen_;
  slept_before_ = std::max(slept_before_, slept);
  stops_seen_ = stops;
  if (!woken) return;
  ++now_.statistics.stops;
  apply(HandSwitch::kForceOff);
}

void ServoLoop::take_chain() noexcept {
  Handover* next = incoming_.exchange(nullptr, std::memory_order_acq_rel);
  if (next == nullptr) return;
  const std::uint64_t number = stepper_.next_number();
  if (recorder_ != nullptr) recorder_->change(number, ChainChange{next->recorded});
  if (faults_ != nullptr) faults_->change(number, ChainChange{next->kept});
  if (next->chain) record(next->chain->settings());
  next->chain = stepper_.exchange_chain(std::move(next->chain));
  const bool kept = retired_.push(next);
  PALPATE_ASSERT(kept);
  (void)kept;
}

void ServoLoop::apply(HandSwitch change) noexcept {
  stepper_.apply(change);
  record(change);
}

void ServoLoop::record(const Change& change) noexcept {
  if (recorder_ != nullptr) recorder_->change(stepper_.next_number(), change);
  if (faults_ != nullptr) faults_->change(stepper_.next_number(), change);
}

void ServoLoop::overran(const Overrun& overrun) noexcept {
  ++now_.statistics.overruns;
  if (recorder_ != nullptr) recorder_->overrun(overrun);
}

}  // namespace palpate
