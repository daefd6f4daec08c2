#include "common/base/job.h"

#include <utility>

namespace palpate {
namespace {

thread_local const Progress* job_of_thread = nullptr;

}  // namespace

JobScope::JobScope(const Progress* job) noexcept : before_(std::exchange(job_of_thread, job)) {}
JobScope::~JobScope() { job_of_thread = before_; }

const Progress* current_job() noexcept { return job_of_thread; }

}  // namespace palpate
