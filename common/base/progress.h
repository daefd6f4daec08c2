/// Progress and cancelling of long jobs. Any number of worker threads advance it, any thread reads it.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace palpate {

/// Shared by a job, whoever watches it and whoever may cancel it. All calls are thread safe except
/// begin(), which only the job's own thread calls.
class Progress {
 public:
  /// Starts a stage of `total` units of work ("reading", "tracing"); 0 means unknown.
  void begin(std::string stage, std::uint64_t total);
  void advance(std::uint64_t units = 1) noexcept { done_.fetch_add(units, std::memory_order_relaxed); }

  /// Asks the job to stop; safe to call from a signal handler.
  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] bool cancelled() const noexcept { return cancelled_.load(std::memory_order_relaxed); }
  /// @throws Cancelled if cancel() was called.
  void check() const;

  [[nodiscard]] std::string stage() const;
  [[nodiscard]] double seconds_in_stage() const;
  /// Part done, in [0, 1]; negative while the total is unknown.
  [[nodiscard]] double fraction() const noexcept;

 private:
  std::atomic<bool> cancelled_{false};
  std::atomic<std::uint64_t> done_{0};
  std::atomic<std::uint64_t> total_{0};
  std::atomic<std::int64_t> stage_start_ns_{0};
  std::atomic<std::shared_ptr<const std::string>> stage_;
};

/// Draws `progress` as a bar with the time left on stderr, from a thread of its own, once a stage has
/// lasted a second, and only if stderr is a terminal. Erases the bar when destroyed.
class ProgressBar {
 public:
  ProgressBar(const Progress& progress, bool quiet);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

 private:
  struct Drawer;
  std::unique_ptr<Drawer> drawer_;
};

}  // namespace palpate
