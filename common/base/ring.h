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
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_seen_ == capacity_) {
      tail_seen_ = tail_.load(std::memory_order_acquire);
      if (head - tail_seen_ == capacity_) {
        dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
        return false;
      }
    }
    items_[head & (capacity_ - 1)] = item;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  /// Consumer only. False where the ring is empty. @rt Safe.
  bool pop(T& item) noexcept {
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_seen_) {
      head_seen_ = head_.load(std::memory_order_acquire);
      if (tail == head_seen_) return false;
    }
    item = items_[tail & (capacity_ - 1)];
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

  /// Items refused since the start; any thread.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }

 private:
  const std::size_t capacity_;
  const std::unique_ptr<T[]> items_;
  alignas(kCacheLine) std::atomic<std::uint64_t> head_{0};  // written by the producer
  std::uint64_t tail_seen_ = 0;
  std::atomic<std::uint64_t> dropped_{0};
  alignas(kCacheLine) std::atomic<std::uint64_t> tail_{0};  // written by the consumer
  std::uint64_t head_seen_ = 0;
};

}  // namespace palpate
