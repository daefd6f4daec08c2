#include "common/base/parallel.h"

#include <atomic>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnceForAnyNumberOfThreads) {
  for (const int threads : {1, 2, 7}) {
    std::vector<std::atomic<int>> visits(10'007);
    parallel_for(visits.size(), threads, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) ++visits[i];
    });
    for (const auto& count : visits) ASSERT_EQ(count.load(), 1);
  }
}

TEST(ParallelFor, RethrowsWhatTheBodyThrows) {
  const auto body = [](std::size_t, std::size_t) { throw std::runtime_error("found"); };
  EXPECT_THROW(parallel_for(100, 2, body), std::runtime_error);
  EXPECT_NO_THROW(parallel_for(0, 2, body)) << "an empty range has nothing to visit";
}

}  // namespace
}  // namespace palpate::test
