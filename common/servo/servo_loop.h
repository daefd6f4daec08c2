/// The servo: a thread that steps the hand at a fixed rate, and what goes in and out of it without waiting.
///
/// Each tick has an absolute deadline. A tick that wakes more than half a period after it is *late*;
/// deadlines that have passed when a tick is done are *skipped*, never caught up in a burst. Steps get the
/// time at which they really ran, so neither changes what the hand feels other than by its sampling. Where the
/// samples of a device come about as often, deadlines follow them (tick_pace.h).
///
/// The thread asks for SCHED_FIFO and for its memory to stay; both may be refused, ServoState::real_time says
/// what was granted. A Watchdog stops the device if the thread stalls, after which the force grows from zero.
/// On destruction the device is sent a zero force. After a sleep of the machine, or of the program (Ctrl-Z), there
/// is none until arm().
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "common/base/last_acts.h"
#include "common/base/ring.h"
#include "common/base/triple_buffer.h"
#include "common/device/device.h"
#include "common/servo/fault_recorder.h"
#include "common/servo/force_end.h"
#include "common/servo/hand_step.h"
#include "common/servo/real_time.h"
#include "common/servo/recorder.h"
#include "common/servo/replay_source.h"
#include "common/servo/time_histogram.h"

namespace palpate {

/// Looks, from a thread of its own, whether beats still come; if the last one is older than the limit it
/// calls Device::emergency_stop(), once a stall. Until the first beat it waits.
class Watchdog {
 public:
  static constexpr std::int64_t kLimit = 20'000'000;  ///< [ns]

  /// `device` outlives it.
  explicit Watchdog(Device& device, std::int64_t limit_ns = kLimit);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Servo thread: it is alive at `now` [ns of CLOCK_MONOTONIC]. @rt Safe.
  void beat(std::int64_t now) noexcept { beat_.store(now, std::memory_order_release); }
  /// Stalls seen so far.
  [[nodiscard]] std::uint64_t stalls() const noexcept { return stalls_.load(std::memory_order_acquire); }

 private:
  void watch(const std::stop_token& stop);

  Device& device_;
  const std::int64_t limit_;
  std::atomic<std::int64_t> beat_{0};
  std::atomic<std::uint64_t> stalls_{0};
  std::mutex sleeping_;
  std::condition_variable_any wake_;
  std::jthread thread_;  // last: it uses all of the above
};

struct ServoOptions {
  double rate = 1000.0;                          ///< [Hz] in [kLeastRate, kMostRate]
  bool real_time = true;                         ///< ask for SCHED_FIFO and locked memory
  std::size_t path_capacity = 1U << 12U;         ///< steps that wait to be drained: 4 s at 1 kHz
  std::int64_t (*slept)() noexcept = &slept_ns;  ///< [ns] for which the machine has slept

  static constexpr double kLeastRate = 100.0;
  static constexpr double kMostRate = 10'000.0;
};

/// @throws Error (usage) for a rate out of bounds.
void check_servo_rate(double rate);

struct ServoStatistics {
  std::uint64_t ticks = 0;
  std::uint64_t late = 0;      ///< woken more than half a period after the deadline
  std::uint64_t skipped = 0;   ///< deadlines that passed while a tick was still at work or asleep
  std::uint64_t overruns = 0;  ///< ticks after which deadlines had passed
  std::uint64_t stalls = 0;    ///< times that the watchdog had to stop the device
  std::uint64_t faults = 0;    ///< times that a ForceCut that is a fault began
  std::uint64_t stops = 0;     ///< times that the machine slept, or the program was stopped
  TimeHistogram lateness;      ///< from deadline to wake-up
  TimeHistogram update;        ///< processor time of a tick: device, changes, step, command
};

/// What the servo publishes each tick.
struct ServoState {
  HandStep hand;
  bool late = false;  ///< this tick
  bool armed = true;
  bool replay_done = false;
  double rate = 0.0;  ///< [Hz] that is asked for
  ServoStatistics statistics;
  std::uint64_t path_dropped = 0;  ///< steps that nobody drained in time
  RealTimeStatus real_time;
  ReplayVerdict replay;  ///< of a replay
};

class ServoLoop {
 public:
  /// Starts with `chain` (null: nothing holds the hand). `device` and the recorders (may be null) outlive the
  /// loop.
  /// @param description of the chain, for the recording. @throws Error (usage) for a rate out of bounds.
  ServoLoop(Device& device, std::unique_ptr<ProxyChain> chain, const std::string& description,
            const ServoOptions& options = {}, Recorder* recorder = nullptr, FaultRecorder* faults = nullptr);
  /// Plays a recording at its own pace, no device on it; changes asked for below are ignored. `replay`
  /// outlives it.
  explicit ServoLoop(ReplaySource& replay, const ServoOptions& options = {});
  /// Ends the thread after its tick, and sends the device a zero force; so does the end of the program in the
  /// middle of its work (LastAct).
  ~ServoLoop();
  ServoLoop(const ServoLoop&) = delete;
  ServoLoop& operator=(const ServoLoop&) = delete;

  // In, from one thread (the window's); nothing waits. Each takes effect before a later step.

  /// The latest settings win. False, and nothing happens, where they are not valid().
  bool set_settings(const ChainSettings& settings) noexcept;
  /// Replaces the chain; the latest one wins. It comes with its settings and no proxies (settings that were
  /// set before it, and not taken yet, reach it too), and the force grows from zero. The old chain, and one
  /// that was replaced before its turn, is deleted here or in collect_retired(), never by the servo.
  void swap_chain(std::unique_ptr<ProxyChain> chain, const std::string& description);
  /// Deletes chains that the servo is done with; call it now and then (once a frame).
  void collect_retired() noexcept;

  // In, from any thread, signal handlers included.

  /// No force until arm(); wins over an arm() in the same tick.
  void force_off() noexcept { off_requests_.fetch_add(1, std::memory_order_acq_rel); }
  void arm() noexcept { arm_requests_.fetch_add(1, std::memory_order_acq_rel); }

  // Out, to one thread.

  /// The latest state, once. False where nothing happened since.
  bool read(ServoState& state) noexcept { return state_.read(state); }
  /// Every step, oldest first. False where there is none left.
  bool pop_step(HandStep& step) noexcept { return path_.pop(step); }
  /// The number of the next step; any thread. For Recorder::event().
  [[nodiscard]] std::uint64_t next_step() const noexcept {
    return next_step_.load(std::memory_order_acquire);
  }

 private:
  /// A chain on its way in, then on its way back. The servo moves pointers, and neither makes nor deletes
  /// one.
  struct Handover {
    std::unique_ptr<ProxyChain> chain;
    std::uint32_t recorded = 0;  ///< number of its description in the recorder
    std::uint32_t kept = 0;      ///< and in the fault recorder
  };

  void start(const ServoOptions& options);
  void let_go();
  void run(const std::stop_token& stop, bool real_time) noexcept;
  void tick(double now) noexcept;
  void play(double now) noexcept;
  void take_changes() noexcept;
  void stop_after_sleep() noexcept;
  void take_chain() noexcept;
  void record(const Change& change) noexcept;
  void overran(const Overrun& overrun) noexcept;
  void apply(HandSwitch change) noexcept;
  void publish(const HandStep& step) noexcept;

  // Shared.
  Ring<Handover*> retired_{4};  // collect_retired() runs before each hand-over, so two wait in it at most
  TripleBuffer<ChainSettings> settings_;
  TripleBuffer<ServoState> state_;
  Ring<HandStep> path_;
  std::atomic<Handover*> incoming_{nullptr};
  std::atomic<std::uint64_t> next_step_{0};
  std::atomic<std::uint32_t> off_requests_{0};
  std::atomic<std::uint32_t> arm_requests_{0};

  Device* device_ = nullptr;
  ReplaySource* replay_ = nullptr;
  Recorder* recorder_ = nullptr;
  FaultRecorder* faults_ = nullptr;
  std::int64_t period_ = 0;  ///< [ns]
  std::optional<Watchdog> watchdog_;

  // The servo thread's.
  HandStepper stepper_;
  ServoState now_;
  std::uint32_t off_seen_ = 0;
  std::uint32_t arm_seen_ = 0;
  std::uint64_t stalls_seen_ = 0;
  std::uint64_t stops_seen_ = 0;
  std::int64_t (*slept_)() noexcept;
  std::int64_t slept_before_;   ///< [ns]
  double replay_start_ = -1.0;  ///< [s] negative: not started
  std::jthread thread_;         // it uses all of the above
  std::optional<LastAct> last_act_;
};

}  // namespace palpate
