#include "common/base/progress.h"

#include <thread>

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace palpate::test {
namespace {

TEST(Progress, CountsFromSeveralThreadsAndStopsAtOne) {
  Progress progress;
  EXPECT_LT(progress.fraction(), 0.0) << "unknown before a stage begins";
  progress.begin("tracing", 4000);
  {
    std::jthread a([&] {
      for (int i = 0; i < 1000; ++i) progress.advance();
    });
    std::jthread b([&] {
      for (int i = 0; i < 1000; ++i) progress.advance();
    });
  }
  EXPECT_EQ(progress.fraction(), 0.5);
  progress.advance(9999);
  EXPECT_EQ(progress.fraction(), 1.0);
  EXPECT_EQ(progress.stage(), "tracing");
}

TEST(Progress, ThrowsWhereACancelledJobLooks) {
  Progress progress;
  EXPECT_NO_THROW(progress.check());
  progress.cancel();
  EXPECT_THROW(progress.check(), Cancelled);
  EXPECT_THROW(progress.begin("next stage", 1), Cancelled);
}

TEST(ProgressBar, PrintsNothingWhereStderrIsNoTerminal) {
  testing::internal::CaptureStderr();
  {
    Progress progress;
    const ProgressBar bar(progress, false);
    progress.begin("reading", 10);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace palpate::test
