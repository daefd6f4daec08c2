#include "common/cli/draw_example.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/base/error.h"

namespace palpate {
namespace {

constexpr int kLowPriority = 10;  // [nice]
constexpr auto kRest = std::chrono::milliseconds(20);

pid_t start(const std::vector<std::string>& arguments) {
  std::vector<char*> words;
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): posix_spawn() leaves them as they are
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t files{};
  posix_spawn_file_actions_init(&files);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&files, stream, "/dev/null", O_RDWR, 0);
  pid_t child = -1;
  const int error = ::posix_spawn(&child, "/proc/self/exe", &files, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0)
    throw work_error(std::string("the program cannot be started again: ") + std::strerror(error));
  return child;
}

}  // namespace

void draw_example(const std::string& example, const std::filesystem::path& to, int width, int height,
                  const std::stop_token& stop) {
  const pid_t child =
      start({"palpate", "render", "--example", example, "--size",
             std::to_string(width) + "x" + std::to_string(height), "--axes", "off", "--color-bar", "off",
             "--outline", "off", "--threads", "1", "--force", "--quiet", "--out", to.string()});
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(child), kLowPriority);
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    if (stop.stop_requested()) ::kill(child, SIGKILL);
    std::this_thread::sleep_for(kRest);
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw work_error(example + ": no picture of it was drawn");
}

}  // namespace palpate
