/// The job that a thread works for. Whoever cancels it is heard by every loop of parallel_for() and by check_job(), though
/// no function on the way there was handed its Progress.
#pragma once

#include "common/base/progress.h"

namespace palpate {

/// While it lives, its thread works for `job`, and so do the loops that it runs on other threads; null: for none, though
/// it did before.
class JobScope {
 public:
  explicit JobScope(const Progress* job) noexcept;
  ~JobScope();
  JobScope(const JobScope&) = delete;
  JobScope& operator=(const JobScope&) = delete;

 private:
  const Progress* before_;
};

/// Of this thread; null: none.
[[nodiscard]] const Progress* current_job() noexcept;

/// For work that is no loop of parallel_for(), every few milliseconds of it.
/// @throws Cancelled where the job of this thread was cancelled.
inline void check_job() {
  if (const Progress* const job = current_job()) job->check();
}

}  // namespace palpate
