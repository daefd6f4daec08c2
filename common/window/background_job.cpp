#include "common/window/background_job.h"

#include <chrono>

#include "common/base/check.h"
#include "common/base/job.h"

namespace palpate {
namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

BackgroundJob::~BackgroundJob() {
  cancel();
  if (thread_.joinable()) thread_.join();
}

void BackgroundJob::start(Work work) {
  PALPATE_CHECK(!running());
  progress_ = std::make_shared<Progress>();
  outcome_ = std::make_shared<Outcome>();
  ended_.store(false);
  started_ = now();
  thread_ = std::thread([this, work = std::move(work), progress = progress_, outcome = outcome_] {
    const JobScope scope(progress.get());
    try {
      outcome->scene = work(*progress);
    } catch (...) {
      outcome->error = std::current_exception();
    }
    ended_.store(true);
    if (wake_) wake_();
  });
}

double BackgroundJob::seconds() const { return now() - started_; }

void BackgroundJob::cancel() noexcept {
  if (progress_) progress_->cancel();
}

std::optional<BackgroundJob::Outcome> BackgroundJob::take() {
  if (!running() || !ended_.load()) return std::nullopt;
  thread_.join();
  return std::move(*outcome_);
}

}  // namespace palpate
