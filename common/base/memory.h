/// Memory of the machine: how much there is, and how large arrays get theirs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <vector>

#include <sys/mman.h>

namespace palpate {

/// Physical memory in bytes; the largest number where the system does not say.
[[nodiscard]] std::uint64_t machine_memory() noexcept;

/// What one piece of work may take of it: three quarters, so that the machine goes on answering.
[[nodiscard]] inline std::uint64_t usable_memory() noexcept { return machine_memory() / 4 * 3; }

// Memory that is about to be filled: its pages are made by several threads, which the first write to each
// would do one after another in one.

/// Makes the pages of [memory, memory + bytes) resident, on up to `threads` threads (0: as many as there are
/// cores). Only a wish: where the system cannot, the first write makes them as ever. Contents stay.
void make_resident(void* memory, std::size_t bytes, int threads) noexcept;

/// Memory for large arrays that are read out of order: asks the system for large pages, so that a read far
/// away costs one miss and not two. Only a wish: where there are none the array works the same.
template <typename T>
struct LargePages {
  using value_type = T;
  static constexpr std::size_t kPage = std::size_t{1} << 21U;  ///< 2 MiB, x86-64's large page

  LargePages() = default;
  template <typename U>
  LargePages(const LargePages<U>&) noexcept {}  // NOLINT: allocators convert

  [[nodiscard]] T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / 2 / sizeof(T)) throw std::bad_array_new_length();
    const std::size_t bytes = count * sizeof(T);
    const bool large = bytes >= 2 * kPage;
    constexpr std::size_t kLine = alignof(T) > 64 ? alignof(T) : 64;  // a cache line, or what T wants
    const std::size_t alignment = large ? kPage : kLine;
    const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
    void* memory = std::aligned_alloc(alignment, rounded);
    if (memory == nullptr) throw std::bad_alloc();
    if (large) (void)madvise(memory, rounded, MADV_HUGEPAGE);
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t) noexcept { std::free(memory); }

  template <typename U>
  bool operator==(const LargePages<U>&) const noexcept {
    return true;
  }
};

/// A vector in large pages, aligned to a cache line at least.
template <typename T>
using LargeVector = std::vector<T, LargePages<T>>;

}  // namespace palpate
