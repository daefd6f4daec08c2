/// A queue of fixed capacity from one thread to one other. Both sides are wait-free: neither ever waits for
/// the other, and what finds the queue full is dropped and counted.
///
/// head counts what was pushed, tail what was popped; a slot is written before head passes it (release) and
/// read after (acquire), and is free again once tail has passed it. Lamport 1983, with the other side's count
/// cached so that its cache line is only fetched when the queue looks full or empty.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>

#include "common/base/cache_line.h"

namespace palpate {

template <typename T>
requires std::is_trivially_copyable_v<T>
class Ring {
 public:
  /// Holds at least `capacity` items: the next power of two. All memory is taken, and touched, here.
  explicit Ring(std::size_t capacity)
      : capacity_(std::bit_ceil(capacity > 0 ? capacity : 1)), items_(std::make_unique<T[]>(capacity_)) {}
  Ring(const Ring&) = delete;
  Ring& operator=(const Ring&) = delete;

  /// Producer only. False, and counted in dropped(), where the ring is full. @rt Safe.
  bool push(const T& item) noexcept {
    const std::uint64_t head = head_.count.load(std::memory_order_relaxed);
    if (head - head_.other == capacity_) {
      head_.other = tail_.count.load(std::memory_order_acquire);
      if (head - head_.other == capacity_) {
        dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
        return false;
      }
    }
    items_[head & (capacity_ - 1)] = item;
    head_.count.store(head + 1, std::memory_order_release);
    return true;
  }

  /// Consumer only. False where the ring is empty. @rt Safe.
  bool pop(T& item) noexcept {
    const std::uint64_t tail = tail_.count.load(std::memory_order_relaxed);
    if (tail == tail_.other) {
      tail_.other = head_.count.load(std::memory_order_acquire);
      if (tail == tail_.other) return false;
    }
    item = items_[tail & (capacity_ - 1)];
    tail_.count.store(tail + 1, std::memory_order_release);
    return true;
  }

  /// Items refused since the start; any thread.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }

 private:
  /// What one side writes: how far it has come, and how far it knows the other side to be.
  struct alignas(kCacheLine) Side {
    std::atomic<std::uint64_t> count{0};
    std::uint64_t other = 0;
  };

  const std::size_t capacity_;
  const std::unique_ptr<T[]> items_;
  std::atomic<std::uint64_t> dropped_{0};  // rarely written
  Side head_;                              // the producer's: pushed
  Side tail_;                              // the consumer's: popped
};

}  // namespace palpate
