/// Stops a device whose servo has stalled.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

#include "common/device/device.h"

namespace palpate {

/// Looks, from a thread of its own, whether beats still come; if the last one is older than the limit it
/// calls Device::emergency_stop(), once a stall. Until the first beat it waits.
class Watchdog {
 public:
  static constexpr std::int64_t kLimit = 20'000'000;  ///< [ns]

  /// `device` outlives it.
  explicit Watchdog(Device& device, std::int64_t limit_ns = kLimit);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Servo thread: it is alive at `now` [ns of CLOCK_MONOTONIC]. @rt Safe.
  void beat(std::int64_t now) noexcept { beat_.store(now, std::memory_order_release); }
  /// Stalls seen so far.
  [[nodiscard]] std::uint64_t stalls() const noexcept { return stalls_.load(std::memory_order_acquire); }

 private:
  void watch(const std::stop_token& stop);

  Device& device_;
  const std::int64_t limit_;
  std::atomic<std::int64_t> beat_{0};
  std::atomic<std::uint64_t> stalls_{0};
  std::mutex sleeping_;
  std::condition_variable_any wake_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace palpate
