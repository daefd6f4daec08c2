#include "common/base/bell.h"

#include <cerrno>
#include <ctime>

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace palpate {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

// Waits of std::atomic have no time limit.
long futex(const std::atomic<std::uint32_t>& word, int act, std::uint32_t value,
           const timespec* until) noexcept {
  static_assert(sizeof(word) == sizeof(std::uint32_t));
  return syscall(SYS_futex, &word, act | FUTEX_PRIVATE_FLAG, value, until, nullptr, FUTEX_BITSET_MATCH_ANY);
}

}  // namespace

void Bell::ring(std::int64_t now) noexcept {
  rang_.store(now, std::memory_order_release);
  count_.fetch_add(1);
  if (waited_for_.load()) (void)futex(count_, FUTEX_WAKE_BITSET, 1, nullptr);
}

void Bell::wait(std::uint32_t count, std::int64_t until) const noexcept {
  const timespec limit{.tv_sec = until / kSecond, .tv_nsec = until % kSecond};
  waited_for_.store(true);
  while (count_.load() == count) {
    // What rings between the look and the sleep has changed the count: the kernel does not let it sleep.
    if (futex(count_, FUTEX_WAIT_BITSET, count, &limit) != 0 && errno == ETIMEDOUT) break;
  }
  waited_for_.store(false);
}

}  // namespace palpate
