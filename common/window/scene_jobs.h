/// The long work behind a window: opening inputs and making scenes of them, one job at a time on a thread of
/// its own.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/window/background_job.h"

namespace palpate {

class SceneJobs {
 public:
  enum class Kind : std::uint8_t { kStart, kOpen, kUpdate };

  /// Begins to read what the model was made for: before there is a window, which takes its own while.
  /// `model` outlives this. @param starts false: nothing is read yet.
  SceneJobs(WindowModel& model, bool starts);

  [[nodiscard]] bool running() const noexcept { return job_.running(); }
  /// Of the job that runs, or ended last.
  [[nodiscard]] Kind kind() const noexcept { return kind_; }
  /// What is shown of the job that runs: of an update only when it is slow, and not while time steps play,
  /// since a bar that comes and goes would move the panel under the mouse. Null: nothing.
  [[nodiscard]] const Progress* shown_progress(bool playing) const;
  /// What the job came to, once it has ended.
  [[nodiscard]] std::optional<BackgroundJob::Outcome> take() { return job_.take(); }

  /// Opens other files as soon as nothing runs, and then those `beside` them, one after the other.
  void open(InputFiles files, const std::vector<InputFiles>& beside) {
    to_open_.assign(beside.begin(), beside.end());
    to_open_.push_front(std::move(files));
  }
  /// What was opened last.
  [[nodiscard]] const InputFiles& opened() const noexcept { return opened_; }
  /// What could not be opened has nothing beside it.
  void forget_beside() noexcept { to_open_.clear(); }
  /// Whether something is read or made, or about to be.
  [[nodiscard]] bool busy() const noexcept { return running() || !to_open_.empty(); }
  /// Has the model forget what is open as soon as nothing runs; what runs is cancelled, and comes to nothing.
  void close();
  [[nodiscard]] bool closing() const noexcept { return to_close_; }
  /// Starts what is next, where nothing runs: opening files, else an update where `wanted` makes another scene
  /// than what was requested.
  void start_next(const Document& wanted);
  /// Of the last job.
  [[nodiscard]] const Document& requested() const noexcept { return requested_; }
  /// The scene that is shown is of this one: nothing is to be updated for it.
  void settle(const Document& document) { requested_ = document; }
  void cancel() noexcept { job_.cancel(); }
  /// The document has changed: a slow update, whose answer is no longer wanted, makes way for the next.
  void give_way();

 private:
  WindowModel& model_;
  Kind kind_ = Kind::kStart;
  Document requested_;
  std::deque<InputFiles> to_open_;
  InputFiles opened_;
  bool to_close_ = false;
  BackgroundJob job_;  // last: its thread uses the model
};

}  // namespace palpate
