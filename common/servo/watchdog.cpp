#include "common/servo/watchdog.h"

#include <chrono>

#include "common/servo/real_time.h"

namespace palpate {
namespace {

constexpr int kWatchdogPriority = 81;  // above the servo: it must run when the servo spins

}  // namespace

Watchdog::Watchdog(Device& device, std::int64_t limit_ns)
    : device_(device), limit_(limit_ns), thread_([this](const std::stop_token& stop) { watch(stop); }) {}

Watchdog::~Watchdog() = default;

void Watchdog::watch(const std::stop_token& stop) {
  request_real_time_priority(kWatchdogPriority);
  std::int64_t reported = 0;
  std::unique_lock lock(sleeping_);
  while (!wake_.wait_for(lock, stop, std::chrono::nanoseconds(limit_ / 4), [] { return false; })) {
    if (stop.stop_requested()) return;
    const std::int64_t last = beat_.load(std::memory_order_acquire);
    if (last == 0 || last == reported || monotonic_ns() - last <= limit_) continue;
    device_.emergency_stop();
    reported = last;
    stalls_.fetch_add(1, std::memory_order_release);
  }
}

}  // namespace palpate
