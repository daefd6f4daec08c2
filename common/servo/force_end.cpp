#include "common/servo/force_end.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <ctime>
#include <mutex>

#include "common/base/index.h"

namespace palpate {
namespace {

// A signal handler can reach nothing but these.
std::atomic<int> holds{0};
std::atomic<std::uint64_t> stops{0};
std::array<std::atomic<int>, ForceEnd::kMost> showing{};  ///< negative: nobody's

constexpr int kNobody = -1;
/// A library that works its device on a thread of its own takes the order of one round in the next.
constexpr int kRoundsToRest = 2;

struct EndingSignal {
  int number;
  bool stops;  ///< else it ends the program
  bool crash;  ///< of the thread that it goes to, whoever handles it
};
// All whose default is to end or to stop a program, but those that nobody can handle.
constexpr std::array kEnding{EndingSignal{SIGHUP, false, false},    EndingSignal{SIGINT, false, false},
                             EndingSignal{SIGQUIT, false, false},   EndingSignal{SIGTERM, false, false},
                             EndingSignal{SIGUSR1, false, false},   EndingSignal{SIGUSR2, false, false},
                             EndingSignal{SIGPIPE, false, false},   EndingSignal{SIGALRM, false, false},
                             EndingSignal{SIGVTALRM, false, false}, EndingSignal{SIGPROF, false, false},
                             EndingSignal{SIGXCPU, false, false},   EndingSignal{SIGXFSZ, false, false},
                             EndingSignal{SIGIO, false, false},     EndingSignal{SIGPWR, false, false},
                             EndingSignal{SIGTSTP, true, false},    EndingSignal{SIGTTIN, true, false},
                             EndingSignal{SIGTTOU, true, false},    EndingSignal{SIGSEGV, false, true},
                             EndingSignal{SIGBUS, false, true},     EndingSignal{SIGFPE, false, true},
                             EndingSignal{SIGILL, false, true},     EndingSignal{SIGABRT, false, true},
                             EndingSignal{SIGTRAP, false, true},    EndingSignal{SIGSYS, false, true}};

std::array<struct sigaction, kEnding.size()> before{};
std::array<bool, kEnding.size()> taken{};

/// Until no link shows a force any more, or kLongest.
void wait_for_rest() noexcept {
  constexpr long kLook = 500'000;  // [ns]
  constexpr int kLooks = static_cast<int>(1e9 * ForceEnd::kLongest / kLook);
  const auto rests = [](const std::atomic<int>& link) { return link.load() <= 0; };
  for (int n = 0; n < kLooks && !std::all_of(showing.begin(), showing.end(), rests); ++n) {
    const timespec pause{.tv_sec = 0, .tv_nsec = kLook};
    nanosleep(&pause, nullptr);
  }
}

extern "C" void on_ending_signal(int number);

struct sigaction own_action() noexcept {
  struct sigaction action {};
  action.sa_handler = on_ending_signal;
  action.sa_flags = SA_RESTART | SA_ONSTACK;
  sigemptyset(&action.sa_mask);
  return action;
}

extern "C" void on_ending_signal(int number) {
  const int saved = errno;
  holds.fetch_add(1);
  wait_for_rest();
  const auto* const known = std::find_if(
      kEnding.begin(), kEnding.end(), [number](const EndingSignal& each) { return each.number == number; });
  const auto i = as_size(known - kEnding.begin());
  sigaction(number, &before[i], nullptr);
  if (!known->stops) {
    raise(number);  // waits until this handler is done, and finds what was there before
  } else {
    sigset_t it;
    sigemptyset(&it);
    sigaddset(&it, number);
    pthread_sigmask(SIG_UNBLOCK, &it, nullptr);
    raise(number);                               // stands still here
    const struct sigaction ours = own_action();  // another thread may stop at the same time
    sigaction(number, &ours, nullptr);
    stops.fetch_add(1);
    holds.fetch_sub(1);
  }
  errno = saved;
}

bool is_plain(const struct sigaction& action, auto handler) noexcept {
  return (action.sa_flags & SA_SIGINFO) == 0 && action.sa_handler == handler;
}

void take_signals() noexcept {
  // A stack that has overflown is none to handle that on.
  static std::array<char, 65536> stack;
  stack_t other{};
  if (sigaltstack(nullptr, &other) == 0 && (other.ss_flags & SS_DISABLE) != 0) {
    other = {.ss_sp = stack.data(), .ss_flags = 0, .ss_size = stack.size()};
    sigaltstack(&other, nullptr);
  }
  const struct sigaction action = own_action();
  for (std::size_t i = 0; i < kEnding.size(); ++i) {
    taken[i] = sigaction(kEnding[i].number, nullptr, &before[i]) == 0 && !is_plain(before[i], SIG_IGN) &&
               (kEnding[i].crash || is_plain(before[i], SIG_DFL)) &&
               sigaction(kEnding[i].number, &action, nullptr) == 0;
  }
}

/// What others have put in our place stays.
void give_signals_back() noexcept {
  for (std::size_t i = 0; i < kEnding.size(); ++i) {
    struct sigaction now {};
    if (taken[i] && sigaction(kEnding[i].number, nullptr, &now) == 0 && is_plain(now, on_ending_signal)) {
      sigaction(kEnding[i].number, &before[i], nullptr);
    }
    taken[i] = false;
  }
}

std::mutex users_mutex;
int users = 0;

}  // namespace

void hold_forces() noexcept { holds.fetch_add(1); }
void release_forces() noexcept { holds.fetch_sub(1); }
std::uint64_t program_stops() noexcept { return stops.load(std::memory_order_acquire); }

ForceEnd::ForceEnd() : shows_(nullptr) {
  const std::lock_guard lock(users_mutex);
  if (users++ == 0) {
    for (std::atomic<int>& link : showing) link = kNobody;
    take_signals();
  }
  auto* const free = std::find_if(showing.begin(), showing.end(),
                                  [](const std::atomic<int>& link) { return link.load() == kNobody; });
  if (free != showing.end()) *(shows_ = free) = 0;
}

ForceEnd::~ForceEnd() {
  const std::lock_guard lock(users_mutex);
  if (shows_ != nullptr) *shows_ = kNobody;
  if (--users == 0) give_signals_back();
}

// The link says that it shows a force, then looks again; the handler holds forces first, then looks: one of
// them sees the other.
bool ForceEnd::may_show() noexcept {
  if (holds.load() > 0) return false;  // what rests stays so, whatever the servo goes on to ask for
  if (shows_ != nullptr) shows_->store(kRoundsToRest);
  return holds.load() <= 0;
}

void ForceEnd::rested() noexcept {
  if (shows_ != nullptr && shows_->load() > 0) shows_->fetch_sub(1);
}

void ForceEnd::leave_signals_to_others() noexcept {
  sigset_t outside;
  sigemptyset(&outside);
  for (const EndingSignal& each : kEnding) {
    if (!each.crash) sigaddset(&outside, each.number);
  }
  pthread_sigmask(SIG_BLOCK, &outside, nullptr);
}

}  // namespace palpate
