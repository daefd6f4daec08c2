/// Memory for large arrays that are read out of order: asks the system for large pages, so that a read far
/// away costs one miss and not two. Only a wish: where there are none the array works the same.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

#include <sys/mman.h>

namespace palpate {

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
