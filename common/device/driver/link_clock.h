/// The clock of links whose bus has none of its own: that of the system, or one that tests move.
#pragma once

#include <chrono>
#include <thread>

namespace palpate {

class LinkClock {
 public:
  LinkClock() = default;
  LinkClock(const LinkClock&) = delete;
  LinkClock& operator=(const LinkClock&) = delete;
  virtual ~LinkClock() = default;

  /// [s] of a clock that only goes forward: CLOCK_MONOTONIC but in tests. Any thread.
  [[nodiscard]] virtual double now() const noexcept = 0;
  virtual void sleep(double seconds) noexcept = 0;
};

class SystemLinkClock final : public LinkClock {
 public:
  [[nodiscard]] double now() const noexcept override {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }
  void sleep(double seconds) noexcept override {
    if (seconds > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  }
};

}  // namespace palpate
