/// One long job at a time on a thread of its own, so that the picture never waits.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "common/base/progress.h"
#include "common/compose/window_model.h"

namespace palpate {

/// All calls come from the thread that owns it.
class BackgroundJob {
 public:
  using Work = std::function<SceneState(Progress&)>;

  /// `wake` is called on the job's thread when the job has ended.
  explicit BackgroundJob(std::function<void()> wake) : wake_(std::move(wake)) {}
  ~BackgroundJob();  ///< cancels the job and waits for it
  BackgroundJob(const BackgroundJob&) = delete;
  BackgroundJob& operator=(const BackgroundJob&) = delete;

  /// @pre !running().
  void start(Work work);
  /// Started, and its outcome not taken yet.
  [[nodiscard]] bool running() const noexcept { return thread_.joinable(); }
  [[nodiscard]] double seconds() const;
  /// @pre running().
  [[nodiscard]] const Progress& progress() const noexcept { return *progress_; }
  void cancel() noexcept;

  struct Outcome {
    std::optional<SceneState> scene;
    std::exception_ptr error;  ///< what was thrown in place of a scene
  };
  /// What the job came to, once it has ended.
  [[nodiscard]] std::optional<Outcome> take();

 private:
  std::function<void()> wake_;
  std::shared_ptr<Progress> progress_;
  std::shared_ptr<Outcome> outcome_;
  std::atomic<bool> ended_{false};
  double started_ = 0.0;  // [s]
  std::thread thread_;
};

}  // namespace palpate
