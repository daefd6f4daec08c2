#include "common/app/cli/interrupt.h"

#include <chrono>
#include <csignal>
#include <thread>

#include <gtest/gtest.h>

#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

TEST(InterruptGuard, CancelsTheJobOnASignal) {
  Progress progress;
  {
    const InterruptGuard guard(progress, "test");
    EXPECT_FALSE(InterruptGuard::interrupted());
    std::raise(SIGINT);
    EXPECT_TRUE(progress.cancelled());
    EXPECT_TRUE(InterruptGuard::interrupted());
  }
  // A second guard starts afresh.
  Progress next;
  const InterruptGuard guard(next, "test");
  EXPECT_FALSE(InterruptGuard::interrupted());
  EXPECT_FALSE(next.cancelled());
}

TEST(InterruptGuard, SaysWhatWasKept) {
  Progress progress;
  InterruptGuard guard(progress, "test");
  EXPECT_EQ(guard.kept(), "nothing was kept");
  guard.keep("a.vtp");
  guard.keep("b.vtp");
  EXPECT_EQ(guard.kept(), "kept: a.vtp, b.vtp");
}

// A job that never looks at its progress: the guard ends the program and removes what was not finished.
TEST(InterruptGuardDeathTest, EndsAJobThatDoesNotNotice) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  const TempFolder folder;
  const auto half = folder.write("half", "half a file");
  EXPECT_EXIT(
      {
        Progress progress;
        InterruptGuard guard(progress, "test");
        guard.keep("a.vtp");
        guard.unfinished(half);
        std::raise(SIGTERM);
        std::this_thread::sleep_for(std::chrono::seconds(5));
        std::filesystem::remove(half);  // not reached
      },
      ::testing::ExitedWithCode(130), "test: interrupted; kept: a.vtp");
}

}  // namespace
}  // namespace palpate::test
