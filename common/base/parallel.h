/// Data-parallel loops on oneTBB, kept behind a plain header.
#pragma once

#include <cstddef>
#include <functional>

namespace palpate {

/// Calls `body(first, last)` for disjoint ranges that together cover [0, count), on up to `threads`
/// threads (0: as many as there are cores). What `body` writes for an index must not depend on the
/// ranges: results are then the same for any number of threads. An exception of `body` is rethrown.
void parallel_for(std::size_t count, int threads,
                  const std::function<void(std::size_t first, std::size_t last)>& body);

/// The number of threads that `threads` stands for (0: as many as there are cores).
[[nodiscard]] int resolve_threads(int threads);

}  // namespace palpate
