// What a helper program may do without harm to its explorer. The helper is a fake one (fake_helper.cpp).
#include "common/load/helper/helper_process.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files/find_helper.h"
#include "common/base/sanitizers.h"
#include "common/load/load.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

constexpr std::uint64_t kMemory = std::uint64_t{256} << 20;
/// More than any machine needs, however slow and busy.
constexpr LoadLimits kTimeEnough{kMemory, 300.0};
/// For helpers that would never end.
constexpr LoadLimits kLittleTime{kMemory, 1.0};

class FakeHelper : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { ::setenv("PALPATE_HELPERS", PALPATE_FAKE_HELPERS, 1); }
  static void TearDownTestSuite() { ::unsetenv("PALPATE_HELPERS"); }

  std::filesystem::path file(const std::string& how) {
    return folder_.write(how + ".vtk", "# vtk DataFile Version 3.0\n");
  }

  /// The error that comes of opening a file for which the helper does `how`; checks its code.
  std::string refusal(const std::string& how, const LoadLimits& limits = kTimeEnough) {
    std::string line;
    try {
      (void)Source::open({{file(how)}, {}}, limits);
      ADD_FAILURE() << how << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput) << how;
      line = error.what();
    }
    return line;
  }

  test::TempFolder folder_;
};

bool contains(const std::string& line, const std::string& part) {
  return line.find(part) != std::string::npos;
}

TEST_F(FakeHelper, ACrashIsOneLineThatNamesFileAndSignal) {
  const std::string line = refusal("crash");
  EXPECT_TRUE(contains(line, "crash.vtk: ")) << line;
  EXPECT_TRUE(contains(line, "signal 11")) << line;
}

TEST_F(FakeHelper, AnEndIsReportedWithTheLastWords) {
  const std::string line = refusal("exit");
  EXPECT_TRUE(contains(line, "status 7")) << line;
  EXPECT_TRUE(contains(line, "the library said no")) << line;
}

TEST_F(FakeHelper, OneThatHangsIsStoppedAtTheTimeLimit) {
  EXPECT_TRUE(contains(refusal("hang", kLittleTime), "stopped after"));
}
// It had no processor for that long: 1.5 s of a limit of 1.4 s.
TEST_F(FakeHelper, OneThatHadToWaitHasItsTime) {
  EXPECT_EQ(Source::open({{file("late")}, {}}, {kMemory, 1.4}).info().times.size(), 2U);
}
TEST_F(FakeHelper, OneThatHangsUpButLivesOnIsEnded) { EXPECT_TRUE(contains(refusal("close"), "ended")); }
TEST_F(FakeHelper, OneThatOnlyReportsProgressIsStoppedToo) {
  EXPECT_TRUE(contains(refusal("flood", kLittleTime), "stopped after"));
}

#if !PALPATE_UNDER_ASAN && !PALPATE_UNDER_TSAN
TEST_F(FakeHelper, AddressSpaceIsLimited) { EXPECT_TRUE(contains(refusal("memory"), "refused after")); }
#endif
TEST_F(FakeHelper, SharedMemoryIsLimited) {
  const std::string line = refusal("file");
  EXPECT_TRUE(contains(line, "signal 25")) << line;
}

TEST_F(FakeHelper, AnswersThatMakeNoSenseAreRefused) {
  for (const char* how : {"unsealed", "outside", "naked", "pipe", "short", "garbage"}) {
    EXPECT_TRUE(contains(refusal(how), "makes no sense")) << how;
  }
}

TEST_F(FakeHelper, ItGetsNoInputAndNoOtherDescriptors) {
  constexpr int kFirst = 40;
  const int leaked = ::fcntl(STDERR_FILENO, F_DUPFD, kFirst);  // without close-on-exec
  const std::string line = refusal("environment");
  // 3 is its socket, 4 the request's memory.
  EXPECT_TRUE(contains(line, "open: 0 1 2 3 4 stdin: -1")) << line;
  ::close(leaked);
}

// Whoever takes a reader over by a damaged file gets no further than its memory.
TEST_F(FakeHelper, TheSandboxLeavesItNoWayOut) {
  const std::string target = folder_.write("target", "mine").string();
  ::setenv("PALPATE_FAKE_TARGET", target.c_str(), 1);
  const std::string line = refusal("sandbox");
  ::unsetenv("PALPATE_FAKE_TARGET");
  if (!contains(line, "files network kept"))
    GTEST_SKIP() << "the kernel has no Landlock or no seccomp: " << line;
  EXPECT_TRUE(contains(line, "got out by.")) << line;
}

TEST_F(FakeHelper, FailingLaterInATimeSeriesIsAnErrorToo) {
  for (const char* how : {"crash", "hang", "garbage"}) {
    Source source = Source::open({{file(std::string("later-") + how)}, {}}, kLittleTime);
    EXPECT_EQ(source.info().times.size(), 2U);
    EXPECT_THROW((void)source.read({"v"}, 1), Error) << how;
    EXPECT_THROW((void)source.read({"v"}, 0), Error) << how << ": the helper is gone";
  }
}

TEST_F(FakeHelper, CancellingEndsItLongBeforeItsTime) {
  Progress progress;
  const Stopwatch clock;
  std::jthread canceller([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    progress.cancel();
  });
  EXPECT_THROW((void)Source::open({{file("hang")}, {}}, kTimeEnough, &progress), Cancelled);
  EXPECT_LT(clock.seconds(), 0.1 * kTimeEnough.seconds);
}

TEST_F(FakeHelper, CtrlCAtTheTerminalDoesNotReachIt) {
  HelperProcess helper(find_helper("palpate-load-vtk"), kTimeEnough);
  // The child ignores the signal before it starts the program; give it the time to get there.
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  ASSERT_EQ(::kill(helper.pid(), SIGINT), 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(::kill(helper.pid(), 0), 0);
  std::ifstream stat("/proc/" + std::to_string(helper.pid()) + "/stat");
  std::string text;
  std::getline(stat, text);
  EXPECT_FALSE(contains(text, ") Z")) << "it has ended";
}

TEST_F(FakeHelper, AHelperThatIsNotThereIsNamed) {
  ::setenv("PALPATE_HELPERS", folder_.path().c_str(), 1);
  try {
    (void)Source::open({{file("any")}, {}});
    ADD_FAILURE() << "was opened";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    EXPECT_TRUE(contains(error.what(), "palpate-load-vtk")) << error.what();
  }
  ::setenv("PALPATE_HELPERS", PALPATE_FAKE_HELPERS, 1);
}

}  // namespace
}  // namespace palpate
