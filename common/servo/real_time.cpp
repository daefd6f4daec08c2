#include "common/servo/real_time.h"

#include <algorithm>
#include <cerrno>
#include <ctime>

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace palpate {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

std::int64_t clock_ns(clockid_t clock) noexcept {
  timespec now{};
  clock_gettime(clock, &now);
  return kSecond * now.tv_sec + now.tv_nsec;
}

bool set_fifo(int priority) noexcept {
  const sched_param param{.sched_priority = priority};
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &param) == 0;
}

}  // namespace

std::int64_t monotonic_ns() noexcept { return clock_ns(CLOCK_MONOTONIC); }

std::int64_t slept_ns() noexcept {
  // A thread that is held up between two clocks would see their difference grow by that.
  constexpr int kTries = 4;
  constexpr std::int64_t kAtOnce = kSecond / 1000;
  std::int64_t nearest = 0, slept = 0;
  for (int i = 0; i < kTries; ++i) {
    const std::int64_t before = clock_ns(CLOCK_MONOTONIC), boot = clock_ns(CLOCK_BOOTTIME),
                       apart = clock_ns(CLOCK_MONOTONIC) - before;
    if (i == 0 || apart < nearest) {
      nearest = apart;
      slept = boot - before - apart / 2;
    }
    if (nearest < kAtOnce) break;
  }
  return slept;
}

std::int64_t thread_cpu_ns() noexcept { return clock_ns(CLOCK_THREAD_CPUTIME_ID); }

void sleep_until_ns(std::int64_t deadline) noexcept {
  const timespec until{.tv_sec = deadline / kSecond, .tv_nsec = deadline % kSecond};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

bool request_real_time_priority(int priority) noexcept {
  if (set_fifo(priority)) return true;
  rlimit allowed{};
  if (getrlimit(RLIMIT_RTPRIO, &allowed) == 0 && allowed.rlim_cur > 0 &&
      set_fifo(static_cast<int>(std::min<rlim_t>(allowed.rlim_cur, static_cast<rlim_t>(priority))))) {
    return true;
  }
  prctl(PR_SET_TIMERSLACK, 1UL);
  return false;
}

bool lock_memory() noexcept {
  rlimit allowed{};
  const bool unlimited =
      geteuid() == 0 || (getrlimit(RLIMIT_MEMLOCK, &allowed) == 0 && allowed.rlim_cur == RLIM_INFINITY);
  // On fault: large arrays that nobody has touched yet stay out of memory.
  return unlimited && mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0;
}

}  // namespace palpate
