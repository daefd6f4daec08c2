/// A clock that stands still until somebody sleeps: what else happens meanwhile is told to it.
#pragma once

#include <functional>
#include <utility>

#include "common/device/driver/link_clock.h"

namespace palpate::test {

class MovedClock final : public LinkClock {
 public:
  [[nodiscard]] double now() const noexcept override { return now_; }
  void sleep(double seconds) noexcept override {
    if (!(seconds > 0.0)) return;
    const double until = now_ + seconds;
    while (now_ < until) {
      now_ = now_ + kStep < until ? now_ + kStep : until;
      if (passing_) passing_();
    }
  }
  /// Called at least every kStep of time that passes.
  void while_time_passes(std::function<void()> passing) { passing_ = std::move(passing); }

  static constexpr double kStep = 0.0005;  ///< [s]

 private:
  double now_ = 0.0;
  std::function<void()> passing_;
};

}  // namespace palpate::test
