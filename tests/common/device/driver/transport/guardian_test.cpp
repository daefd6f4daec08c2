// The process that outlives a program: what it writes, when, and when not. The program is killed as nobody can
// handle, the wire is a pipe.

#include "common/device/driver/transport/guardian.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::array<std::uint8_t, 4> kZero{'<', 'A', 0x80, '>'};

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class GuardianTest : public ::testing::Test {
 protected:
  GuardianTest() {
    EXPECT_EQ(::mkfifo(line_.c_str(), 0600), 0);
    wire_ = ::open(line_.c_str(), O_RDWR);  // so that it never ends
  }
  ~GuardianTest() override { ::close(wire_); }

  /// What comes within `seconds`, until there are `enough` bytes.
  Bytes heard(double seconds, std::size_t enough) const {
    Bytes bytes;
    for (const double until = now() + seconds; now() < until && bytes.size() < enough;) {
      pollfd wire{.fd = wire_, .events = POLLIN, .revents = 0};
      if (::poll(&wire, 1, 5) != 1) continue;
      std::array<std::uint8_t, 64> some{};
      const auto got = ::read(wire_, some.data(), some.size());
      bytes.insert(bytes.end(), some.begin(), some.begin() + std::max<ssize_t>(got, 0));
    }
    return bytes;
  }
  /// On a busy machine it may take longer to start than a link waits for.
  Guardian started(std::span<const std::uint8_t> word, int times) const {
    Guardian guardian({"file", line_}, word, times);
    for (int tries = 0; tries < 20 && !guardian.watches(); ++tries)
      guardian = Guardian({"file", line_}, word, times);
    return guardian;
  }
  /// A program that has left its word; `then` is what it does next.
  template <class Then>
  pid_t program(const Then& then) const {
    const pid_t process = ::fork();
    if (process != 0) return process;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // nothing is left behind where the test is ended
    const Guardian guardian = started(kZero, 3);
    if (!guardian.watches()) ::_exit(1);
    (void)!::write(wire_, "!", 1);
    then();
    ::_exit(2);
  }
  static void wait_for(pid_t process) {
    while (::waitpid(process, nullptr, 0) < 0 && errno == EINTR) {
    }
  }

  TempFolder folder_;
  std::string line_ = folder_.path("line").string();
  int wire_ = -1;
};

TEST_F(GuardianTest, WritesItsWordWhereTheProgramIsKilled) {
  for (const int number : {SIGKILL, SIGSEGV, SIGTERM, SIGINT}) {
    const pid_t process = program([] {
      for (;;) ::pause();
    });
    ASSERT_EQ(heard(20.0, 1), Bytes{'!'});
    EXPECT_TRUE(heard(0.05, 1).empty()) << "not before";
    const double killed = now();
    // A terminal sends its signals to the group.
    ::kill(process, number);
    const Bytes said = heard(20.0, 12);
    const double late = now() - killed;
    std::printf("signal %d: the word after %.2f ms\n", number, 1e3 * late);
    Bytes expected;
    for (int n = 0; n < 3; ++n) expected.insert(expected.end(), kZero.begin(), kZero.end());
    EXPECT_EQ(said, expected);
    EXPECT_LT(late, 10.0) << "a busy machine; 0.2 s on one that is not";
    wait_for(process);
  }
}

TEST_F(GuardianTest, EndsWithoutAWordWhereItIsLetGo) {
  {
    Guardian guardian = started(kZero, 3);
    ASSERT_TRUE(guardian.watches());
    Guardian other = std::move(guardian);
    EXPECT_TRUE(other.watches());
    EXPECT_FALSE(guardian.watches());  // NOLINT(bugprone-use-after-move): it is none
  }
  EXPECT_TRUE(heard(0.1, 1).empty());
}

TEST_F(GuardianTest, SaysWhereItCannotWatch) {
  EXPECT_FALSE(Guardian({"file", folder_.path("nowhere").string()}, kZero, 1).watches());
  EXPECT_FALSE(Guardian({"usb", folder_.path("nowhere").string(), "0", "2"}, kZero, 1).watches());
  EXPECT_FALSE(Guardian({"what"}, kZero, 1).watches());
  EXPECT_FALSE(Guardian().watches());
}

// Two of them: neither keeps the other's pipe open.
TEST_F(GuardianTest, EachWatchesForItself) {
  const pid_t process = program([this] {
    const Guardian second = started(std::array<std::uint8_t, 1>{'2'}, 1);
    (void)!::write(wire_, "?", 1);
    for (;;) ::pause();
  });
  ASSERT_EQ(heard(20.0, 2), (Bytes{'!', '?'}));
  ::kill(process, SIGKILL);
  EXPECT_EQ(heard(20.0, 13).size(), 13U);
  wait_for(process);
}

}  // namespace
}  // namespace palpate::test
