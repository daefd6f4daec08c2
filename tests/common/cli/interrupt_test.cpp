#include "common/cli/interrupt.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "common/base/files/output_file.h"
#include "common/servo/force_end.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

TEST(InterruptGuard, CancelsTheJobOnASignalAndHoldsForcesMeanwhile) {
  ForceEnd link;
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    Progress progress;
    const InterruptGuard guard(progress, "test");
    EXPECT_FALSE(InterruptGuard::interrupted());
    EXPECT_TRUE(link.may_show());
    std::raise(number);
    EXPECT_TRUE(progress.cancelled());
    EXPECT_TRUE(InterruptGuard::interrupted());
    EXPECT_FALSE(link.may_show());
  }
  EXPECT_TRUE(link.may_show());
  // A second guard starts afresh.
  Progress next;
  const InterruptGuard guard(next, "test");
  EXPECT_FALSE(InterruptGuard::interrupted());
  EXPECT_FALSE(next.cancelled());
}

TEST(InterruptGuard, SaysWhatWasKept) {
  Progress progress;
  InterruptGuard guard(progress, "test");
  EXPECT_EQ(guard.saved(), "nothing was saved");
  guard.keep("a.vtp");
  guard.keep("b.vtp");
  EXPECT_EQ(guard.saved(), "saved: a.vtp, b.vtp");
}

// A job that never looks at its progress: the guard ends the program and removes what was not finished.
TEST(InterruptGuardDeathTest, EndsAJobThatDoesNotNotice) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  // The child is this program started anew: it works in the folder of the one that watches it.
  constexpr const char* kVariable = "PALPATE_TEST_FOLDER";
  const TempFolder own;
  setenv(kVariable, own.path().c_str(), 0);
  const std::filesystem::path folder = std::getenv(kVariable);
  const auto half = folder / "half";
  std::ofstream(half) << "half a file";
  EXPECT_EXIT(
      {
        Progress progress;
        InterruptGuard guard(progress, "test");
        guard.keep("a.vtp");
        guard.unfinished(half);
        OutputFile output(folder / "b.vtp", false);
        output.write("begun");
        std::raise(SIGTERM);
        std::this_thread::sleep_for(std::chrono::seconds(5));
        std::filesystem::remove(half);  // not reached
      },
      ::testing::ExitedWithCode(130), "test: interrupted; saved: a.vtp");
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  unsetenv(kVariable);
}

}  // namespace
}  // namespace palpate::test
