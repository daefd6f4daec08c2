#include "common/load/helper/helper_process.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <limits>
#include <stdexcept>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/sanitizers.h"

namespace palpate {
namespace {

// The sanitizers reserve terabytes of address space, so a limit on it would stop every helper.
constexpr bool kLimitAddressSpace = PALPATE_UNDER_ASAN == 0 && PALPATE_UNDER_TSAN == 0;

/// How often a wait looks at the cancel flag [ms].
constexpr int kCancelPoll = 50;

void limit(__rlimit_resource resource, std::uint64_t value) {
  const rlimit both{value, value};
  ::setrlimit(resource, &both);
}

/// The child's part between fork and exec: nothing but system calls, since other threads' locks may be held.
[[noreturn]] void become_helper(const char* program, int socket, int errors, std::uint64_t memory_bytes,
                                char* const* environment) {
  // The two descriptors may lie on the numbers that they go to, so both move out of the way first.
  const int socket_high = ::fcntl(socket, F_DUPFD, 16);
  const int errors_high = ::fcntl(errors, F_DUPFD, 16);
  const int null = ::open("/dev/null", O_RDWR);
  if (socket_high < 0 || errors_high < 0 || null < 0) ::_exit(126);
  ::dup2(null, STDIN_FILENO);
  ::dup2(null, STDOUT_FILENO);
  ::dup2(errors_high, STDERR_FILENO);
  ::dup2(socket_high, kHelperSocket);
  ::close_range(kHelperSocket + 1, ~0U, 0);

  // An ignored signal stays ignored through exec: Ctrl-C is the explorer's to handle.
  ::signal(SIGINT, SIG_IGN);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);  // NOLINT(concurrency-mt-unsafe): the child has one thread

  limit(RLIMIT_CORE, 0);
  // Memory files count as files, not as address space: both limits are needed.
  limit(RLIMIT_FSIZE, memory_bytes);
  if (kLimitAddressSpace) limit(RLIMIT_AS, memory_bytes);

  std::array<char*, 2> arguments{const_cast<char*>(program), nullptr};
  ::execve(program, arguments.data(), environment);
  ::_exit(127);
}

/// The last line that is not empty.
std::string last_line(int fd) {
  std::array<char, 2048> tail{};
  const off_t end = ::lseek(fd, 0, SEEK_END);
  const off_t start = std::max<off_t>(0, end - static_cast<off_t>(tail.size()));
  const ssize_t got = ::pread(fd, tail.data(), tail.size(), start);
  if (got <= 0) return {};
  std::string text(tail.data(), as_size(got));
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace

HelperProcess::HelperProcess(const std::filesystem::path& program, const LoadLimits& limits)
    : limits_(limits) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw work_error(std::string("cannot start a loader: ") + errno_text());
  }
  socket_.reset(ends[0]);
  const UniqueFd theirs(ends[1]);
  errors_.reset(::memfd_create("palpate-errors", MFD_CLOEXEC));

  // One malloc arena: each further one would reserve 64 MiB of the address space that is limited.
  const bool limited = limits_.memory_bytes != kUnlimited.memory_bytes;
  std::vector<std::string> settings;
  if (limited) settings.emplace_back("MALLOC_ARENA_MAX=1");
  std::vector<char*> environment;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    if (!limited || std::strncmp(*entry, "MALLOC_ARENA_MAX=", 17) != 0) environment.push_back(*entry);
  }
  for (std::string& setting : settings) environment.push_back(setting.data());
  environment.push_back(nullptr);

  pid_ = ::fork();
  if (pid_ < 0) throw work_error(std::string("cannot start a loader: ") + errno_text());
  if (pid_ == 0) {
    become_helper(program.c_str(), theirs.get(), errors_.get(), limits_.memory_bytes, environment.data());
  }
}

HelperProcess::~HelperProcess() { end(); }

void HelperProcess::end() noexcept {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGKILL);
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
}

std::string HelperProcess::how_it_ended() {
  // A helper that closes its socket and lives on gets a moment, then the kill signal.
  constexpr int kMoments = 50;
  int status = 0;
  pid_t reaped = 0;
  for (int moment = 0; reaped == 0; ++moment) {
    if (moment == kMoments) ::kill(pid_, SIGKILL);
    reaped = ::waitpid(pid_, &status, moment < kMoments ? WNOHANG : 0);
    if (reaped < 0 && errno == EINTR) reaped = 0;
    if (reaped == 0) ::usleep(5000);
  }
  pid_ = -1;
  if (reaped < 0) return "ended";
  if (WIFSIGNALED(status)) {
    return "ended by signal " + std::to_string(WTERMSIG(status)) + " (" + ::sigdescr_np(WTERMSIG(status)) +
           ")";
  }
  std::string how = "ended with status " + std::to_string(WEXITSTATUS(status));
  const std::string line = last_line(errors_.get());
  return line.empty() ? how : how + " (" + line + ")";
}

// Time for which the helper and its threads have had a processor [s]; infinite where nobody knows.
double HelperProcess::worked() const noexcept {
  clockid_t clock{};
  timespec time{};
  if (::clock_getcpuclockid(pid_, &clock) != 0 || ::clock_gettime(clock, &time) != 0)
    return std::numeric_limits<double>::infinity();
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::optional<HelperProcess::Reply> HelperProcess::fail(HelperFailure::Kind kind, std::string what) {
  end();
  socket_.reset();
  failure_ = {kind, std::move(what)};
  return std::nullopt;
}

std::optional<HelperProcess::Reply> HelperProcess::ask(std::string_view json, Progress* progress) {
  MemoryFile none;
  return ask(none, json, progress, "reading");
}

std::optional<HelperProcess::Reply> HelperProcess::ask(
    MemoryFile& request, std::string_view json, Progress* progress, const std::string& doing,
    const std::function<void(std::string_view json)>& news) {
  using Clock = std::chrono::steady_clock;
  if (pid_ <= 0) return std::nullopt;
  if (!send_message(socket_.get(), request, json)) return fail(HelperFailure::Kind::kEnded, how_it_ended());

  constexpr std::uint64_t kParts = 1000;
  if (progress != nullptr) progress->begin(doing, kParts);
  std::string stage = doing;
  std::uint64_t reported = 0;
  constexpr double kPatience = 3.0, kBusy = 0.5;  // of the limit
  const auto begin = Clock::now();
  const double worked_before = worked();
  const auto too_long = [&](double seconds) {
    // A helper that had to wait for a processor, or a disk, has not had its time.
    return seconds > limits_.seconds &&
           (seconds > kPatience * limits_.seconds || worked() - worked_before >= kBusy * limits_.seconds);
  };
  while (true) {
    if (progress != nullptr && progress->cancelled()) {
      (void)fail(HelperFailure::Kind::kEnded, "was cancelled");
      throw Cancelled();
    }
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    if (too_long(seconds)) {
      std::array<char, 96> text{};
      std::snprintf(text.data(), text.size(), "was stopped after %.0f s (it had a processor for %.1f s)",
                    seconds, worked() - worked_before);
      return fail(HelperFailure::Kind::kTimeOut, text.data());
    }
    Frame frame;
    UniqueFd fd;
    switch (receive_frame(socket_.get(), kCancelPoll, frame, fd)) {
      case Received::kTimeOut:
        continue;
      case Received::kClosed:
        return fail(HelperFailure::Kind::kEnded, how_it_ended());
      case Received::kMalformed:
        return fail(HelperFailure::Kind::kMalformed, "sent a packet of the wrong shape");
      case Received::kFrame:
        break;
    }
    if (frame.kind == Frame::kProgress) {
      frame.stage.back() = '\0';
      if (const std::string next = frame.stage.data(); !next.empty() && next != stage) {
        stage = next;
        reported = 0;
        if (progress != nullptr) progress->begin(stage, frame.fraction < 0.0 ? 0 : kParts);
      }
      const auto parts = frame.fraction > 0.0 && frame.fraction <= 1.0
                             ? static_cast<std::uint64_t>(frame.fraction * kParts)
                             : 0;
      if (progress != nullptr && parts > reported) {
        progress->advance(parts - reported);
        reported = parts;
      }
      continue;
    }
    if ((frame.kind != Frame::kMessage && frame.kind != Frame::kNews) || !fd)
      return fail(HelperFailure::Kind::kMalformed, "sent an unknown packet");
    try {
      Reply reply;
      reply.memory = MappedMemory::map(fd);
      reply.json = json_of(frame, reply.memory->bytes());
      if (frame.kind == Frame::kMessage) return reply;
      if (news) news(reply.json);
    } catch (const std::runtime_error& error) {
      return fail(HelperFailure::Kind::kMalformed, error.what());
    }
  }
}

}  // namespace palpate
