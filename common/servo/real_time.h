/// Clocks and scheduling of a thread that must wake on time.
#pragma once

#include <cstdint>

namespace palpate {

/// CLOCK_MONOTONIC [ns].
[[nodiscard]] std::int64_t monotonic_ns() noexcept;
/// CLOCK_BOOTTIME less CLOCK_MONOTONIC [ns]: how long the machine has slept since it was switched on.
[[nodiscard]] std::int64_t slept_ns() noexcept;
/// Processor time of the calling thread [ns]: what it used itself, whatever else the machine does.
[[nodiscard]] std::int64_t thread_cpu_ns() noexcept;
/// Sleeps until CLOCK_MONOTONIC is `deadline` [ns], an absolute time, so that errors do not add up.
void sleep_until_ns(std::int64_t deadline) noexcept;

/// What the system allowed.
struct RealTimeStatus {
  bool real_time_priority = false;  ///< SCHED_FIFO
  bool memory_locked = false;       ///< pages in use are never paged out
};

/// Gives the calling thread SCHED_FIFO at `priority` or, if that is more than is allowed, the most that is;
/// without it, timers are at least not delayed to be served together (timer slack 1 ns).
/// @return whether the thread has a real-time priority now.
bool request_real_time_priority(int priority) noexcept;

/// Keeps the pages of the process in memory from the moment they are used. Only where no limit stands against
/// it: under a finite limit later allocations of the whole program would fail.
/// @return whether it does.
bool lock_memory() noexcept;

}  // namespace palpate
