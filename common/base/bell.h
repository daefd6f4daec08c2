/// What one thread rings when it has something new, and another waits for: neither takes a lock.
#pragma once

#include <atomic>
#include <cstdint>

namespace palpate {

class Bell {
 public:
  Bell() = default;
  Bell(const Bell&) = delete;
  Bell& operator=(const Bell&) = delete;

  /// One thread. @param now CLOCK_MONOTONIC [ns], later than at the ring before. @rt Safe.
  void ring(std::int64_t now) noexcept;
  struct Rang {
    std::uint32_t count = 0;  ///< times that it rang, modulo 2^32
    std::int64_t last = 0;    ///< when it did last [ns]; of the ring that is under way, too
  };
  /// @rt Safe.
  [[nodiscard]] Rang rang() const noexcept {
    const std::uint32_t count = count_.load();
    return {count, rang_.load(std::memory_order_acquire)};
  }
  /// Sleeps until it has rung more often than `count` times, or CLOCK_MONOTONIC is `until` [ns]. One thread.
  void wait(std::uint32_t count, std::int64_t until) const noexcept;

 private:
  std::atomic<std::int64_t> rang_{0};
  std::atomic<std::uint32_t> count_{0};
  mutable std::atomic<bool> waited_for_{false};
};

}  // namespace palpate
