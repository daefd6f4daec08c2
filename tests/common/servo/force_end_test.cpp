// Every way in which a program can end, seen from the wire: a program of its own, whose link writes each command
// into a pipe, dies, and the last command is zero.

#include "common/servo/force_end.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/servo/linked_device.h"
#include "common/servo/real_time.h"
#include "common/servo/servo_loop.h"

namespace palpate::test {
namespace {

/// One command at the wire.
struct Word {
  std::int64_t time = 0;  ///< [ns]
  double force = 0.0;     ///< [N] NaN: the end begins
};

class WireLink final : public DriverLink {
 public:
  explicit WireLink(int wire) : wire_(wire) { atoms_.has_position = true; }
  bool round() noexcept override {
    const Vec3 force = ordered();
    say({monotonic_ns(), force.x});
    if (force.x != 0.0) shown_ = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    atoms_.time = 1e-9 * static_cast<double>(monotonic_ns());
    return true;
  }
  [[nodiscard]] bool shown() const { return shown_; }
  void say(const Word& word) const { (void)!::write(wire_, &word, sizeof(word)); }
  [[nodiscard]] const DeviceAtoms& atoms() const noexcept override { return atoms_; }
  [[nodiscard]] const LinkStatus& status() const noexcept override { return status_; }
  [[nodiscard]] std::string advice() const override { return {}; }
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }
  [[nodiscard]] std::string place() const override { return {}; }

 private:
  int wire_;
  DeviceAtoms atoms_;
  LinkStatus status_;
  DeviceLimits limits_;
  std::atomic<bool> shown_{false};
};

constexpr double kWarm = 0.05;  // [s] for which the program has shown a force before it ends

/// A program that shows 1 N, and then does `end`.
class Program {
 public:
  explicit Program(const std::function<void()>& end) {
    std::array<int, 2> pipe_ends{};
    EXPECT_EQ(::pipe(pipe_ends.data()), 0);
    heard_ = pipe_ends[0];
    process_ = ::fork();
    if (process_ != 0) {
      ::close(pipe_ends[1]);
      return;
    }
    ::setpgid(0, 0);  // Ctrl-Z stops a program of a shell, none that nobody can wake
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    const auto link = std::make_shared<WireLink>(pipe_ends[1]);
    LinkedDevice device(link);
    std::jthread servo([&device](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        device.command({1.0, 0.0, 0.0});
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
    for (int n = 0; n < 20'000 && !link->shown(); ++n)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::duration<double>(kWarm));
    link->say({monotonic_ns(), NAN});
    end();
    std::this_thread::sleep_for(std::chrono::seconds(20));  // it was to end
    ::_exit(99);
  }
  ~Program() {
    if (!ended_) ::kill(process_, SIGKILL);
    while (!ended_ && ::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
    ::close(heard_);
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Its status once it has ended, or has stopped.
  int wait(int options = 0) {
    int status = 0;
    while (::waitpid(process_, &status, options) < 0 && errno == EINTR) {
    }
    ended_ = !WIFSTOPPED(status);
    return status;
  }
  /// All that was said since the last call.
  std::vector<Word> heard() const {
    std::vector<Word> words;
    ::fcntl(heard_, F_SETFL, O_NONBLOCK);
    for (Word word; ::read(heard_, &word, sizeof(word)) == sizeof(word);) words.push_back(word);
    return words;
  }
  [[nodiscard]] pid_t process() const { return process_; }

 private:
  pid_t process_ = 0;
  int heard_ = -1;
  bool ended_ = false;
};

/// Whether the last command was zero. A thread that the machine gives no time to for the whole of ForceEnd::kLongest says
/// nothing more: that may happen to one program on a busy machine, not to several in a row.
bool ends_silent(const std::vector<Word>& words) { return !words.empty() && words.back().force == 0.0; }
constexpr int kTries = 4;

/// Says how long it took from the beginning of the end to the first command of zero.
void expect_last_zero(const std::vector<Word>& words, const char* what) {
  std::int64_t began = 0, silent = 0;
  bool forced = false;
  for (const Word& word : words) {
    if (std::isnan(word.force)) {
      began = word.time;
    } else if (word.force != 0.0) {
      forced = true;
      silent = 0;
    } else if (silent == 0) {
      silent = word.time;
    }
  }
  ASSERT_TRUE(forced) << what;
  ASSERT_NE(began, 0) << what;
  ASSERT_EQ(words.back().force, 0.0) << what;
  const double late = std::max(0.0, 1e-6 * static_cast<double>(silent - began));
  std::printf("%s: no force after %.2f ms\n", what, late);
  EXPECT_LT(late, 2000.0) << what;  // a busy machine; 50 on one that is not
}

TEST(ForceEnd, SignalsThatEndAProgramLeaveNoForce) {
  for (const int number :
       {SIGHUP,  SIGINT, SIGQUIT, SIGTERM, SIGPIPE, SIGUSR1, SIGUSR2, SIGALRM, SIGXCPU, SIGXFSZ, SIGVTALRM,
        SIGPROF, SIGIO,  SIGPWR,  SIGSEGV, SIGBUS,  SIGFPE,  SIGILL,  SIGABRT, SIGTRAP, SIGSYS}) {
    std::vector<Word> words;
    int status = 0;
    for (int n = 0; n < kTries && !ends_silent(words); ++n) {
      Program program([number] { ::kill(::getpid(), number); });
      status = program.wait();
      words = program.heard();
    }
    // Under a sanitizer a crash is told, then the program ends by itself.
    EXPECT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) != 99) << number;
    if (WIFSIGNALED(status)) {
      EXPECT_EQ(WTERMSIG(status), number) << "it ends as it would have";
    }
    expect_last_zero(words, ("signal " + std::to_string(number)).c_str());
  }
}

void touch_forbidden() {
  constexpr std::size_t kPage = 4096;
  void* const page = ::mmap(nullptr, kPage, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  *static_cast<int volatile*>(page) = 1;
}

TEST(ForceEnd, CrashesLeaveNoForce) {
  const std::array<std::pair<const char*, std::function<void()>>, 6> ends{{
      {"abort", [] { std::abort(); }},
      {"an exception that nobody caught",
       [] { std::thread([] { throw std::runtime_error("nobody"); }).join(); }},
      {"terminate", [] { std::terminate(); }},
      {"a page that is not its own", touch_forbidden},
      {"the same on another thread", [] { std::thread(touch_forbidden).join(); }},
      {"a write to a pipe that nobody reads",
       [] {
         std::array<int, 2> ends_of_pipe{};
         if (::pipe(ends_of_pipe.data()) != 0) return;
         ::close(ends_of_pipe[0]);
         (void)!::write(ends_of_pipe[1], "x", 1);
       }},
  }};
  for (const auto& [name, end] : ends) {
    std::vector<Word> words;
    for (int n = 0; n < kTries && !ends_silent(words); ++n) {
      Program program(end);
      const int status = program.wait();
      EXPECT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) != 99) << name;
      words = program.heard();
    }
    expect_last_zero(words, name);
  }
}

/// Stops twice, and is woken each time. @return what was said before each of the stops.
std::array<std::vector<Word>, 2> stop_twice(int number) {
  Program program([number] {
    for (int n = 0; n < 2; ++n) {
      ::kill(::getpid(), number);
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
    ::_exit(static_cast<int>(program_stops()));
  });
  std::array<std::vector<Word>, 2> heard;
  for (std::vector<Word>& words : heard) {
    EXPECT_TRUE(WIFSTOPPED(program.wait(WUNTRACED))) << number;
    words = program.heard();
    // It goes on; whether there is force then is for the servo.
    ::kill(program.process(), SIGCONT);
  }
  const int status = program.wait();
  EXPECT_TRUE(WIFEXITED(status)) << number;
  EXPECT_EQ(WEXITSTATUS(status), 2) << number;
  return heard;
}

TEST(ForceEnd, AStoppedProgramShowsNoForce) {
  for (const int number : {SIGTSTP, SIGTTIN, SIGTTOU}) {
    std::array<std::vector<Word>, 2> heard;
    for (int n = 0; n < kTries && !(ends_silent(heard[0]) && ends_silent(heard[1])); ++n)
      heard = stop_twice(number);
    expect_last_zero(heard[0], ("stop " + std::to_string(number)).c_str());
    EXPECT_TRUE(ends_silent(heard[1])) << number;
  }
}

TEST(ForceEnd, IgnoredAndHandledSignalsAreLeftAlone) {
  struct sigaction before {};
  std::signal(SIGHUP, SIG_IGN);
  const auto theirs = [](int) {};
  std::signal(SIGUSR1, theirs);
  {
    const ForceEnd end;
    sigaction(SIGHUP, nullptr, &before);
    EXPECT_EQ(before.sa_handler, SIG_IGN);
    sigaction(SIGUSR1, nullptr, &before);
    EXPECT_EQ(before.sa_handler, static_cast<void (*)(int)>(theirs));
    sigaction(SIGQUIT, nullptr, &before);
    EXPECT_NE(before.sa_handler, SIG_DFL);
  }
  sigaction(SIGQUIT, nullptr, &before);
  EXPECT_EQ(before.sa_handler, SIG_DFL);
  std::signal(SIGHUP, SIG_DFL);
  std::signal(SIGUSR1, SIG_DFL);
}

/// A hand that rests, on a device that pushes.
class RestingDevice final : public Device {
 public:
  bool read(double now, DeviceSample& sample) noexcept override {
    sample = {now, Vec3{0.0, 0.0, 0.01}, 0};
    return true;
  }
  void command(const Vec3& force) noexcept override { force_.store(glm::length(force)); }
  void emergency_stop() noexcept override {}
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }
  [[nodiscard]] double force() const { return force_.load(); }

 private:
  DeviceLimits limits_;
  std::atomic<double> force_{0.0};
};

class PullToOrigin final : public Constraint {
 public:
  void apply(const ChainSettings& /*settings*/) noexcept override {}
  void reset() noexcept override {}
  void update(const Vec3& /*probe*/, const UpdateBudget& /*budget*/, LinkUpdate& link) noexcept override {
    link.proxy = Vec3{0.0};
    link.state = HoldState::kHeld;
  }
};

std::atomic<std::int64_t> slept{0};

TEST(ForceEnd, AMachineThatSleptShowsNoForceUntilItIsArmed) {
  const auto comes = [](const auto& what) {
    for (int n = 0; n < 20'000; ++n) {
      if (what()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  };
  RestingDevice device;
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::make_unique<PullToOrigin>());
  ServoLoop servo(device, std::make_unique<ProxyChain>(std::move(links), ChainSettings{}), "pull",
                  {.real_time = false, .slept = []() noexcept { return slept.load(); }});
  ASSERT_TRUE(comes([&] { return device.force() > 0.5; }));
  slept += 3'000'000'000;
  ASSERT_TRUE(comes([&] { return device.force() == 0.0; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(device.force(), 0.0);
  ServoState state;
  ASSERT_TRUE(servo.read(state));
  EXPECT_FALSE(state.armed);
  EXPECT_EQ(state.statistics.stops, 1U);
  servo.arm();
  EXPECT_TRUE(comes([&] { return device.force() > 0.5; }));
}

}  // namespace
}  // namespace palpate::test
