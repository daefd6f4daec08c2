/// Keeps the last seconds of the servo in memory, and saves them where something went wrong.
///
/// A fault is a ForceCut that is one, and a stall of the servo. What led to it and kAftermath after it are
/// written, by a thread of its own, as a recording (recording.h) that `--replay` plays:
/// FOLDER/PROGRAM-fault-1.rec, and so on. While one is being written the next is not kept; after kMostFiles
/// faults are only counted, so that a device that keeps failing does not fill the disk. Of a program's files, those
/// of other runs too, the latest kKept stay.
///
/// Where the hand was off the device once in that time the file begins there, since all proxies are forgotten
/// then: a replay has the very proxies and forces of the run, and checks it. Else it begins as long ago as
/// memory goes, in the midst of what proxies hold, and what is felt in a replay may differ at first; nothing
/// is compared then. So it is too where motors may grow warm (DeviceLimits::continuous_cap), which nothing
/// makes forget.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <variant>
#include <vector>

#include "common/servo/recording.h"

namespace palpate {

class FaultRecorder {
 public:
  static constexpr double kSeconds = 10.0;    ///< that are kept
  static constexpr double kAftermath = 0.25;  ///< [s] of them after the fault
  static constexpr int kMostFiles = 8;
  static constexpr std::size_t kKept = 20;

  /// Takes all memory. The folder is made when there is something to put in it.
  /// @param rate of the servo [Hz].
  FaultRecorder(std::filesystem::path folder, RecordingHeader header, double rate);
  ~FaultRecorder();
  FaultRecorder(const FaultRecorder&) = delete;
  FaultRecorder& operator=(const FaultRecorder&) = delete;

  // Servo thread. @rt Safe.

  void change(std::uint64_t step, const Change& change) noexcept;
  void step(const HandInput& input, const HandStep& step) noexcept;
  /// The watchdog had to stop the device.
  void stalled() noexcept { begin_fault(); }

  // Window thread.

  /// See Recorder::describe_chain().
  [[nodiscard]] std::uint32_t describe_chain(std::string_view description);
  /// Ends the writing, after a fault whose aftermath was cut short. The servo no longer uses it.
  void finish();
  /// The newest file, once; or why one could not be written.
  [[nodiscard]] std::optional<std::string> news();
  /// Faults that were seen; any thread.
  [[nodiscard]] std::uint64_t faults() const noexcept { return faults_.load(std::memory_order_relaxed); }

 private:
  struct StepEntry {
    HandInput input;
    HandStep step;
  };
  /// Settings are many times as large as a step: they lie apart, and an entry names their slot.
  struct Slot {
    std::size_t index = 0;
  };
  struct ChangeEntry {
    std::uint64_t step = 0;
    std::variant<HandSwitch, ChainChange, Slot> what;
  };
  using Entry = std::variant<StepEntry, ChangeEntry>;

  /// What is in place after some entry.
  struct Situation {
    std::optional<std::uint32_t> chain;
    std::optional<ChainSettings> settings;
    bool off = false;

    void take(const Change& change) noexcept;
    void take(const HandStep& step, const DeviceLimits& limits) noexcept;
  };

  /// The latest entries.
  class Memory {
   public:
    void reserve(std::size_t entries);
    /// Forgets all, and begins in `before`.
    void begin(const Situation& before) noexcept;
    void add(const StepEntry& entry, const DeviceLimits& limits) noexcept;
    void add(std::uint64_t step, const Change& change, const DeviceLimits& limits) noexcept;

    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    /// Oldest first.
    [[nodiscard]] const Entry& at(std::size_t i) const noexcept {
      return entries_[(first_ + i) % entries_.size()];
    }
    [[nodiscard]] Change change_of(const ChangeEntry& entry) const noexcept;
    /// In place before the oldest entry.
    [[nodiscard]] const Situation& before() const noexcept { return before_; }
    /// Takes what `entry`, one of these, does to a situation.
    void take(const Entry& entry, Situation& situation, const DeviceLimits& limits) const noexcept;

   private:
    void drop_oldest(const DeviceLimits& limits) noexcept;
    void push(const Entry& entry, const DeviceLimits& limits) noexcept;

    std::vector<Entry> entries_;
    std::vector<ChainSettings> settings_;
    std::size_t first_ = 0, count_ = 0;
    std::size_t settings_first_ = 0, settings_next_ = 0;  ///< count those that were dropped and added
    Situation before_;
  };

  void begin_fault() noexcept;
  void hand_over() noexcept;
  void write_loop(const std::stop_token& stop);
  void save(const Memory& memory);
  [[nodiscard]] std::string text_of(const Memory& memory);
  /// Numbers of the files that are there, from the least on.
  [[nodiscard]] std::vector<std::uint64_t> numbers() const;
  [[nodiscard]] std::filesystem::path file_of(std::uint64_t number) const;
  void prune() const;

  static constexpr int kNone = -1;

  const std::filesystem::path folder_;
  const RecordingHeader header_;
  const std::uint64_t aftermath_;  ///< steps
  std::array<Memory, 2> memories_;

  // Servo thread.
  int active_ = 0;  ///< index of the memory that is filled
  Situation now_;
  ForceCut cut_ = ForceCut::kNone;      ///< of the last step
  std::optional<std::uint64_t> to_go_;  ///< steps until the fault is handed over
  int files_ = 0;

  std::atomic<int> handed_{kNone};  ///< index of the memory that is to be written
  std::atomic<std::uint64_t> faults_{0};

  std::mutex mutex_;  ///< of the next two
  std::vector<std::string> descriptions_;
  std::optional<std::string> news_;
  std::condition_variable_any wake_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace palpate
