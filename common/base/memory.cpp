#include "common/base/memory.h"

#include <cstdint>

#include <sys/mman.h>
#include <unistd.h>

#include "common/base/parallel.h"

namespace palpate {

std::uint64_t machine_memory() noexcept {
  const long pages = ::sysconf(_SC_PHYS_PAGES), page = ::sysconf(_SC_PAGESIZE);
  return pages > 0 && page > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page)
                               : ~std::uint64_t{0};
}

void make_resident([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes,
                   [[maybe_unused]] int threads) noexcept {
#ifdef MADV_POPULATE_WRITE
  constexpr std::uintptr_t kPiece = std::uintptr_t{1} << 23U;  // whole pages, large ones too
  const auto begin = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t first = (begin + kPiece - 1) / kPiece * kPiece, end = begin + bytes;
  if (end < first + 2 * kPiece) return;
  try {
    parallel_for((end - first) / kPiece, threads, [&](std::size_t from, std::size_t to) {
      std::byte* const piece = static_cast<std::byte*>(memory) + (first - begin) + from * kPiece;
      (void)madvise(piece, (to - from) * kPiece, MADV_POPULATE_WRITE);
    });
  } catch (...) {  // NOLINT(bugprone-empty-catch): without threads the first write makes them
  }
#endif
}

}  // namespace palpate
