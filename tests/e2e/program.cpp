#include "tests/e2e/program.h"

#include <cstdlib>

#include <poll.h>
#include <sys/wait.h>

#include "tests/support/project_folders.h"

namespace palpate::test {

Program::Program(std::vector<std::string> command, const std::filesystem::path& folder,
                 const std::vector<std::string>& environment) {
  int out[2];
  int err[2];
  if (pipe(out) != 0 || pipe(err) != 0) std::abort();
  pid_ = fork();
  if (pid_ == 0) {
    dup2(out[1], STDOUT_FILENO);
    dup2(err[1], STDERR_FILENO);
    for (const int fd : {out[0], out[1], err[0], err[1]}) close(fd);
    if (chdir(folder.c_str()) != 0) _exit(127);
    for (const std::string& setting : environment) {
      const auto equals = setting.find('=');
      if (equals + 1 == setting.size()) {
        unsetenv(setting.substr(0, equals).c_str());
      } else {
        setenv(setting.substr(0, equals).c_str(), setting.c_str() + equals + 1, 1);
      }
    }
    std::vector<char*> arguments;
    for (std::string& argument : command) arguments.push_back(argument.data());
    arguments.push_back(nullptr);
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  close(out[1]);
  close(err[1]);
  fds_[0] = out[0];
  fds_[1] = err[0];
}

Program::~Program() {
  if (pid_ > 0) (void)finish(0.0);
}

ProgramResult Program::finish(double limit) {
  ProgramResult result;
  std::string* const texts[2] = {&result.out, &result.err};
  bool open[2] = {true, true};
  while (open[0] || open[1]) {
    pollfd polled[2] = {{open[0] ? fds_[0] : -1, POLLIN, 0}, {open[1] ? fds_[1] : -1, POLLIN, 0}};
    if (seconds() > limit) kill(pid_, SIGKILL);
    (void)poll(polled, 2, 100);
    for (int s = 0; s < 2; ++s) {
      if ((polled[s].revents & (POLLIN | POLLHUP)) == 0) continue;
      char buffer[65536];
      const ssize_t count = read(fds_[s], buffer, sizeof buffer);
      if (count > 0) {
        texts[s]->append(buffer, static_cast<std::size_t>(count));
      } else {
        open[s] = false;
      }
    }
  }
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  close(fds_[0]);
  close(fds_[1]);
  result.seconds = seconds();
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

std::filesystem::path bin(const std::string& name) { return build_folder() / "bin" / name; }

}  // namespace palpate::test
