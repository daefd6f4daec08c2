#include "common/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include "common/base/sanitizers.h"

namespace palpate {
namespace {

#if PALPATE_UNDER_TSAN
/// ThreadSanitizer sees nothing of how TBB's library, which is not built with it, hands work over and back:
/// it would report every use of a result as a race, and a suppression would hide our own races with them.
/// Under it the pieces are shared among plain threads, whose start and join it knows.
void run_pieces(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& body) {
  const std::size_t piece = std::max<std::size_t>(1, count / (8 * static_cast<std::size_t>(threads)));
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> errors(static_cast<std::size_t>(threads));
  std::vector<std::jthread> workers;
  for (std::exception_ptr& error : errors) {
    workers.emplace_back([&] {
      try {
        for (std::size_t first = 0; (first = next.fetch_add(piece)) < count;)
          body(first, std::min(count, first + piece));
      } catch (...) {
        error = std::current_exception();
        next = count;
      }
    });
  }
  workers.clear();  // joins
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}
#else
void run_pieces(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& body) {
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count),
                      [&](const tbb::blocked_range<std::size_t>& r) { body(r.begin(), r.end()); });
  });
}
#endif

}  // namespace

int resolve_threads(int threads) {
  return threads > 0 ? threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  const int used = resolve_threads(threads);
  if (used == 1) {
    body(0, count);
    return;
  }
  run_pieces(count, used, body);
}

}  // namespace palpate
