/// Runs a built program as a user does: arguments in, both streams and the exit code out.
#pragma once

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>
#include <unistd.h>

namespace palpate::test {

struct ProgramResult {
  int exit_code = -1;  ///< 128 + signal where one ended it
  std::string out;
  std::string err;
  double seconds = 0.0;
};

/// A program under way.
class Program {
 public:
  /// @param environment "NAME=value"; "NAME=" unsets the variable.
  explicit Program(std::vector<std::string> command, const std::filesystem::path& folder = ".",
                   const std::vector<std::string>& environment = {});
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  [[nodiscard]] pid_t pid() const noexcept { return pid_; }
  void signal(int number) const { kill(pid_, number); }

  /// Reads both streams to their ends and waits; kills the program after `limit` seconds.
  ProgramResult finish(double limit = 120.0);

  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  pid_t pid_ = -1;
  int fds_[2] = {-1, -1};
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

[[nodiscard]] std::filesystem::path bin(const std::string& name);

}  // namespace palpate::test
