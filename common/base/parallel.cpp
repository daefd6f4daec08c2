#include "common/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <thread>
#include <vector>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include "common/base/index.h"
#include "common/base/job.h"
#include "common/base/sanitizers.h"

namespace palpate {
namespace {

#if PALPATE_UNDER_TSAN
/// ThreadSanitizer sees nothing of how TBB's library, which is not built with it, hands work over and back:
/// it would report every use of a result as a race, and a suppression would hide our own races with them.
/// Under it the pieces are shared among plain threads, whose start and join it knows.
void run_pieces(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& body) {
  const std::size_t piece = std::max<std::size_t>(1, count / (8 * as_size(threads)));
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> errors(as_size(threads));
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
/// The calling thread's own, for as long as it lives: workers find the next loop where they were at the last
/// one. From an arena that is gone they part only after many a yield, each of which costs a time slice where
/// other programs run, and meanwhile a thread works alone.
tbb::task_arena& arena_of(int threads) {
  thread_local std::map<int, tbb::task_arena> arenas;
  return arenas.try_emplace(threads, threads).first->second;
}

void run_pieces(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& body) {
  // A loop within a loop waits for its own pieces alone: another one of the outer loop might want a lock that
  // this one holds.
  arena_of(threads).execute([&] {
    tbb::this_task_arena::isolate([&] {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count),
                        [&](const tbb::blocked_range<std::size_t>& r) { body(r.begin(), r.end()); });
    });
  });
}
#endif

/// The same in pieces of a job that may be cancelled: it is looked at between them, on whichever thread they are.
std::function<void(std::size_t, std::size_t)> in_pieces(
    std::size_t count, int threads, const Progress& job,
    const std::function<void(std::size_t, std::size_t)>& body) {
  constexpr std::size_t kPieces = 64;  // a thread
  const std::size_t piece = std::max<std::size_t>(1, count / (kPieces * as_size(threads)));
  return [piece, &job, &body](std::size_t first, std::size_t last) {
    const JobScope scope(&job);
    while (first < last) {
      job.check();
      const std::size_t end = last - first > piece ? first + piece : last;
      body(first, end);
      first = end;
    }
  };
}

}  // namespace

int resolve_threads(int threads) {
  return threads > 0 ? threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  const int used = resolve_threads(threads);
  if (const Progress* const job = current_job()) {
    const auto pieces = in_pieces(count, used, *job, body);
    if (used == 1) {
      pieces(0, count);
    } else {
      run_pieces(count, used, pieces);
    }
    return;
  }
  if (used == 1) {
    body(0, count);
    return;
  }
  run_pieces(count, used, body);
}

}  // namespace palpate
