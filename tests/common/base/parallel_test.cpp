#include "common/base/parallel.h"

#include <atomic>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/job.h"

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

TEST(ParallelFor, HearsThatTheJobOfItsThreadWasCancelled) {
  for (const int threads : {1, 2}) {
    Progress job;
    const JobScope scope(&job);
    std::atomic<std::size_t> visited{0};
    constexpr std::size_t kCount = 100'000;
    const auto body = [&](std::size_t first, std::size_t last) {
      EXPECT_EQ(current_job(), &job) << "loops within the loop hear it, too";
      visited += last - first;
      if (visited > kCount / 10) job.cancel();
    };
    EXPECT_THROW(parallel_for(kCount, threads, body), Cancelled);
    EXPECT_LT(visited.load(), kCount / 2);
    const JobScope none(nullptr);
    EXPECT_NO_THROW(parallel_for(10, threads, [](std::size_t, std::size_t) {}));
    EXPECT_NO_THROW(check_job());
  }
  EXPECT_EQ(current_job(), nullptr);
}

}  // namespace
}  // namespace palpate::test
