/// Writes a recording (recording.h) while a run goes on.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "common/base/last_acts.h"
#include "common/base/ring.h"
#include "common/servo/recording.h"

namespace palpate {

/// The servo pushes into a ring, a thread of the recorder's own formats and writes; what is written is handed
/// to the system each second, so that a crash costs a second. Not written under a temporary name: it must
/// survive one. Where the program is ended in the middle of its work (LastAct), the recording ends there in
/// order. A file that it overwrites waits as "NAME~" until the recording is whole.
class Recorder {
 public:
  static constexpr std::size_t kCapacity = 1U << 14U;  ///< entries: 16 s at 1 kHz

  /// Makes the file and writes its header.
  /// @throws Error (usage) where `path` exists and `overwrite` is not set, or is an input; (work failed) where it cannot be
  /// written.
  Recorder(std::filesystem::path path, const RecordingHeader& header, bool overwrite,
           std::size_t capacity = kCapacity);
  /// As finish(), but in silence.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // Servo thread. @rt Safe.

  void change(std::uint64_t step, const Change& change) noexcept {
    (void)ring_.push(RecordedChange{step, change});
  }
  void step(const HandInput& input, const HandStep& step) noexcept {
    (void)ring_.push(StepEntry{input, step});
  }
  void overrun(const Overrun& overrun) noexcept { (void)ring_.push(overrun); }

  // Window thread.

  /// What to write for the chain that is about to be put in place; the number goes into ChainChange.
  [[nodiscard]] std::uint32_t describe_chain(std::string_view description);
  void event(std::uint64_t step, std::uint64_t frame, std::string_view text);
  /// Writes what is left, and the end. The servo no longer uses it.
  /// @throws Error (work failed) where the disk refused something.
  void finish();

  /// Entries that the ring had no room for; the recording says so too. Any thread.
  [[nodiscard]] std::uint64_t lost() const noexcept { return ring_.dropped(); }
  /// Whether the disk refused; nothing more is written then. Any thread.
  [[nodiscard]] bool failed() const noexcept { return failed_.load(std::memory_order_acquire); }

 private:
  struct StepEntry {
    HandInput input;
    HandStep step;
  };
  using Entry = std::variant<RecordedChange, StepEntry, Overrun>;
  struct WindowEvent {
    std::uint64_t step, frame;
    std::string text;
  };
  struct CloseFile {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };

  void write_loop(const std::stop_token& stop);
  void drain();
  void end();
  void end_soon();
  void write(const RecordedChange& change);
  void write(const StepEntry& entry) { text_.step(entry.input, entry.step); }
  void write(const Overrun& overrun) { text_.overrun(overrun); }
  void flush() noexcept;
  [[noreturn]] void refuse(int error) const;

  std::filesystem::path path_;
  std::filesystem::path earlier_;  ///< what `path_` was; empty: there was nothing
  std::unique_ptr<std::FILE, CloseFile> file_;
  RecordingText text_;  ///< not written yet
  Ring<Entry> ring_;
  std::uint64_t lost_written_ = 0;
  std::atomic<bool> failed_{false};
  std::atomic<int> error_{0};

  std::mutex mutex_;                       ///< of the two below
  std::vector<std::string> descriptions_;  ///< of chains
  std::vector<WindowEvent> events_;        ///< that wait to be written
  std::condition_variable_any wake_;
  std::atomic<bool> end_asked_{false}, ended_{false};
  std::jthread thread_;  // it uses all of the above
  std::optional<LastAct> last_act_;
};

}  // namespace palpate
