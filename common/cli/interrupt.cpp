#include "common/cli/interrupt.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <mutex>
#include <thread>
#include <vector>

#include <semaphore.h>
#include <unistd.h>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/base/last_acts.h"
#include "common/servo/force_end.h"

namespace palpate {
namespace {

// A signal handler can reach nothing but these.
std::atomic<Progress*> cancelled_progress{nullptr};
std::atomic<int> signals_seen{0};
sem_t signal_arrived;

constexpr long kGraceNanoseconds = 800'000'000;  // the contract says a second; the rest is for leaving

extern "C" void on_signal(int) {
  const int saved = errno;
  if (signals_seen.fetch_add(1) == 0) hold_forces();
  if (Progress* progress = cancelled_progress.load()) progress->cancel();
  sem_post(&signal_arrived);
  errno = saved;
}

}  // namespace

struct InterruptGuard::State {
  std::string program;
  std::mutex mutex;
  std::vector<std::filesystem::path> saved;
  std::vector<std::filesystem::path> unfinished;
  struct sigaction old_interrupt {};
  struct sigaction old_terminate {};
  struct sigaction old_hang_up {};
  std::atomic<bool> over{false};
  std::thread watchdog;

  std::string saved_text() {
    const std::lock_guard lock(mutex);
    if (saved.empty()) return "nothing was saved";
    std::string text = "saved: ";
    for (const auto& path : saved) text += (path == saved.front() ? "" : ", ") + path.string();
    return text;
  }

  [[noreturn]] void end_now() {
    run_last_acts();
    remove_unfinished_outputs();
    const std::string line = "\n" + program + ": interrupted; " + saved_text() + "\n";
    {
      const std::lock_guard lock(mutex);
      std::error_code ignored;
      for (const auto& path : unfinished) std::filesystem::remove_all(path, ignored);
    }
    // Not std::exit: destructors would wait for the very job that does not end.
    [[maybe_unused]] const auto written = write(STDERR_FILENO, line.data(), line.size());
    _exit(static_cast<int>(ExitCode::kInterrupted));
  }

  void watch() {
    while (sem_wait(&signal_arrived) != 0) {
    }
    if (over) return;
    timespec end{};
    clock_gettime(CLOCK_MONOTONIC, &end);  // which nobody sets back
    end.tv_nsec += kGraceNanoseconds;
    end.tv_sec += end.tv_nsec / 1'000'000'000;
    end.tv_nsec %= 1'000'000'000;
    while (sem_clockwait(&signal_arrived, CLOCK_MONOTONIC, &end) != 0 && errno == EINTR) {
    }
    if (!over) end_now();
  }
};

InterruptGuard::InterruptGuard(Progress& progress, std::string program) : state_(std::make_unique<State>()) {
  PALPATE_CHECK(cancelled_progress.load() == nullptr);
  state_->program = std::move(program);
  signals_seen = 0;
  sem_init(&signal_arrived, 0, 0);
  cancelled_progress = &progress;
  state_->watchdog = std::thread([state = state_.get()] { state->watch(); });

  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, &state_->old_interrupt);
  sigaction(SIGTERM, &action, &state_->old_terminate);
  sigaction(SIGHUP, nullptr, &state_->old_hang_up);
  // nohup: who closes the terminal wants the program to go on.
  if (state_->old_hang_up.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
}

InterruptGuard::~InterruptGuard() {
  sigaction(SIGINT, &state_->old_interrupt, nullptr);
  sigaction(SIGTERM, &state_->old_terminate, nullptr);
  sigaction(SIGHUP, &state_->old_hang_up, nullptr);
  if (interrupted()) release_forces();
  state_->over = true;
  sem_post(&signal_arrived);
  state_->watchdog.join();
  cancelled_progress = nullptr;
  sem_destroy(&signal_arrived);
}

bool InterruptGuard::interrupted() noexcept { return signals_seen.load() > 0; }

void InterruptGuard::keep(const std::filesystem::path& output) {
  const std::lock_guard lock(state_->mutex);
  state_->saved.push_back(output);
}

void InterruptGuard::unfinished(const std::filesystem::path& temporary) {
  const std::lock_guard lock(state_->mutex);
  state_->unfinished.push_back(temporary);
}

std::string InterruptGuard::saved() const { return state_->saved_text(); }

}  // namespace palpate
