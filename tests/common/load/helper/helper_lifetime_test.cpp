// A real helper program ends when its explorer does, also in the middle of its work.
#include <chrono>
#include <csignal>
#include <fstream>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/base/files/find_helper.h"
#include "common/load/helper/helper_process.h"

namespace palpate {
namespace {

TEST(HelperLifetime, AHelperEndsWhenItsExplorerIsKilled) {
  int pipe[2];
  ASSERT_EQ(::pipe(pipe), 0);
  const pid_t explorer = ::fork();
  ASSERT_GE(explorer, 0);
  if (explorer == 0) {
    HelperProcess helper(find_helper("palpate-load-nrrd"), {std::uint64_t{1} << 30, 10.0});
    const pid_t pid = helper.pid();
    (void)!::write(pipe[1], &pid, sizeof(pid));
    while (true) ::pause();
  }
  pid_t helper = 0;
  ASSERT_EQ(::read(pipe[0], &helper, sizeof(helper)), static_cast<ssize_t>(sizeof(helper)));
  ::close(pipe[0]);
  ::close(pipe[1]);
  EXPECT_EQ(::kill(helper, 0), 0);
  ::kill(explorer, SIGKILL);
  ASSERT_EQ(::waitpid(explorer, nullptr, 0), explorer);
  // Whoever inherits the helper reaps it; its socket closes at once.
  bool gone = false;
  for (int i = 0; i < 100 && !gone; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    std::ifstream stat("/proc/" + std::to_string(helper) + "/stat");
    std::string text;
    gone = !std::getline(stat, text) || text.find(") Z") != std::string::npos;
  }
  EXPECT_TRUE(gone);
}

}  // namespace
}  // namespace palpate
