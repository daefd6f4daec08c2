/// What it takes from the start of a window to its first picture: each repeat in a process of its own, so that no page and
/// no shader is there from before.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <utility>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/base/error.h"

namespace palpate::bench {

/// Opens a file in a window that ends after so many pictures, and calls `shown` before the model goes.
using OpenFile = std::function<void(const char* file, int frames, const std::function<void()>& shown)>;

inline double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

inline void print_use(const char* name, int who) {
  rusage use{};
  getrusage(who, &use);
  std::printf("  %s %.2f + %.2f s", name, seconds_of(use.ru_utime), seconds_of(use.ru_stime));
}

/// Proportional shares of a process and those that it started [kB].
struct Memory {
  double own = 0.0, shared = 0.0, files = 0.0;

  [[nodiscard]] double without_files() const noexcept { return own + shared; }
};

inline void add_memory(const std::string& pid, Memory& sum) {
  std::ifstream rollup("/proc/" + pid + "/smaps_rollup");
  std::string word;
  while (rollup >> word) {
    double* const to = word == "Pss_Anon:"    ? &sum.own
                       : word == "Pss_Shmem:" ? &sum.shared
                       : word == "Pss_File:"  ? &sum.files
                                              : nullptr;
    double kilobytes = 0.0;
    if (to != nullptr && rollup >> kilobytes) *to += kilobytes;
  }
  std::error_code ignored;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/" + pid + "/task", ignored)) {
    std::ifstream children(thread.path() / "children");
    for (std::string child; children >> child;) add_memory(child, sum);
  }
}

/// Looks at the memory of a process until it ends. @return its exit status.
inline int watch_memory(pid_t process, Memory& most, Memory& last) {
  int status = 0;
  while (waitpid(process, &status, WNOHANG) == 0) {
    Memory now;
    add_memory(std::to_string(process), now);
    if (now.without_files() > 0.0) last = now;
    if (now.without_files() > most.without_files()) most = now;
    constexpr std::chrono::milliseconds kRest{20};
    std::this_thread::sleep_for(kRest);
  }
  return status;
}

/// [--repeat N] [--memory FRAMES] FILE: times of the wall clock and of processors, those of the program and of its helper;
/// or the most memory until so many pictures are drawn, and that after the last one.
inline int run_openings(int argc, char** argv, const OpenFile& open) {
  int repeat = 3, frames = 1;
  const char* file = nullptr;
  for (int i = 1; i < argc; ++i) {
    const bool more = i + 1 < argc;
    if (more && std::strcmp(argv[i], "--repeat") == 0) {
      repeat = std::atoi(argv[++i]);
    } else if (more && std::strcmp(argv[i], "--memory") == 0) {
      frames = std::atoi(argv[++i]);
    } else {
      file = argv[i];
    }
  }
  if (file == nullptr || repeat < 1 || frames < 1) throw usage_error("a file to open is expected");
  const bool memory = frames > 1;
  std::printf("%s: to the first %s\n", file,
              memory ? (std::to_string(frames) + " pictures").c_str() : "picture");
  for (int n = 0; n < repeat; ++n) {
    std::fflush(stdout);
    const auto began = std::chrono::steady_clock::now();
    const pid_t child = fork();
    if (child == 0) {
      open(file, frames, [&] {
        const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
        std::printf("  wall %.2f s", wall);
        print_use("program", RUSAGE_SELF);
      });
      print_use("helper", RUSAGE_CHILDREN);  // it has ended with the model
      std::printf("  (user + system)\n");
      std::fflush(stdout);
      _exit(0);
    }
    Memory most, last;
    int status = 1;
    if (memory) {
      status = watch_memory(child, most, last);
    } else if (child > 0) {
      waitpid(child, &status, 0);
    }
    if (child < 0 || status != 0) throw work_error(std::string(file) + " was not opened");
    constexpr double kMegabyte = 1024.0;
    for (const auto& [name, of] : {std::pair{"most", &most}, {"last", &last}}) {
      if (memory)
        std::printf("  %s: %.0f MB of its own, %.0f MB shared with its helper, %.0f MB of files\n", name,
                    of->own / kMegabyte, of->shared / kMegabyte, of->files / kMegabyte);
    }
  }
  return 0;
}

/// What main() does of such a bench.
inline int open_and_say(const char* bench, int argc, char** argv, const OpenFile& open) {
  try {
    return run_openings(argc, argv, open);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", bench, error.what());
    return 1;
  }
}

}  // namespace palpate::bench
