#include "common/device/driver/transport/guardian.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/base/files/find_helper.h"

namespace palpate {
namespace {

constexpr int kStartTime = 700;  // [ms] that starting it may take: less than the longest round

/// Two lower-case digits a byte.
std::string hex(std::span<const std::uint8_t> bytes) {
  constexpr std::array kDigits{'0', '1', '2', '3', '4', '5', '6', '7',
                               '8', '9', 'a', 'b', 'c', 'd', 'e', 'f'};
  std::string text;
  for (const std::uint8_t byte : bytes) (text += kDigits[byte >> 4U]) += kDigits[byte & 15U];
  return text;
}

/// It hears nothing of a terminal, and keeps no file of ours open.
pid_t start(const std::string& program, std::vector<std::string> arguments, int pipe) {
  std::vector<char*> words;
  for (std::string& each : arguments) words.push_back(each.data());
  words.push_back(nullptr);
  posix_spawn_file_actions_t files{};
  posix_spawnattr_t manner{};
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, pipe, STDIN_FILENO);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
  posix_spawnattr_init(&manner);
  posix_spawnattr_setflags(&manner, POSIX_SPAWN_SETPGROUP);
  std::array<char*, 1> no_environment{nullptr};
  pid_t process = 0;
  const int error =
      posix_spawn(&process, program.c_str(), &files, &manner, words.data(), no_environment.data());
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&manner);
  return error == 0 ? process : 0;
}

}  // namespace

Guardian::Guardian(const std::vector<std::string>& line, std::span<const std::uint8_t> word, int times) {
  const std::string program = find_helper("palpate-guardian").string();
  std::array<int, 2> ends{-1, -1};
  if (program.empty() || ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return;
  std::vector<std::string> arguments{program, std::to_string(times), hex(word)};
  arguments.insert(arguments.end(), line.begin(), line.end());
  process_ = start(program, std::move(arguments), ends[1]);
  ::close(ends[1]);
  pipe_ = ends[0];
  // It says that it has its line.
  pollfd answer{.fd = pipe_, .events = POLLIN, .revents = 0};
  char said = 0;
  const bool ready = process_ > 0 && ::poll(&answer, 1, kStartTime) == 1 && ::read(pipe_, &said, 1) == 1;
  if (ready) return;
  if (process_ > 0) ::kill(process_, SIGKILL);  // it would be waited for
  let_go();
}

Guardian::~Guardian() { let_go(); }

Guardian::Guardian(Guardian&& other) noexcept
    : process_(std::exchange(other.process_, 0)), pipe_(std::exchange(other.pipe_, -1)) {}

Guardian& Guardian::operator=(Guardian&& other) noexcept {
  if (this == &other) return *this;
  let_go();
  process_ = std::exchange(other.process_, 0);
  pipe_ = std::exchange(other.pipe_, -1);
  return *this;
}

void Guardian::let_go() noexcept {
  if (pipe_ >= 0) {
    (void)::send(pipe_, "q", 1, MSG_NOSIGNAL);  // all is well
    ::close(std::exchange(pipe_, -1));
  }
  if (process_ <= 0) return;
  while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
  process_ = 0;
}

}  // namespace palpate
