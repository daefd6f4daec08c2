/// The latest value from one thread to one other. Both sides are wait-free: the writer never waits for a slow
/// reader, the reader always finds the newest complete value, and values in between are lost.
///
/// Three slots: one belongs to the writer, one to the reader, and the third is handed over by exchanging its
/// number, with a flag that says whether it holds something that was not read yet.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

#include "common/base/cache_line.h"

namespace palpate {

template <typename T>
requires std::is_trivially_copyable_v<T>
class TripleBuffer {
 public:
  TripleBuffer() = default;
  TripleBuffer(const TripleBuffer&) = delete;
  TripleBuffer& operator=(const TripleBuffer&) = delete;

  /// Writer only. @rt Safe.
  void write(const T& value) noexcept {
    slots_[back_].value = value;
    back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & ~kFresh;
  }

  /// Reader only: copies the newest value, once. False, and `value` untouched, where nothing was written
  /// since the last call. @rt Safe.
  bool read(T& value) noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & ~kFresh;
    value = slots_[front_].value;
    return true;
  }

 private:
  static constexpr std::uint32_t kFresh = 4;
  struct alignas(kCacheLine) Slot {
    T value{};
  };

  std::array<Slot, 3> slots_{};
  alignas(kCacheLine) std::uint32_t back_ = 0;   // the writer's slot
  alignas(kCacheLine) std::uint32_t front_ = 1;  // the reader's slot
  alignas(kCacheLine) std::atomic<std::uint32_t> middle_{2};
};

}  // namespace palpate
