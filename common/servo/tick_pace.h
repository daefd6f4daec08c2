/// When the servo ticks: at its own rate, or with the samples of a device that keeps about the same.
///
/// Between a tick and a device of the same rate lies any moment: where the tick comes right before the device's next
/// command, its force misses that one and waits for another period. One that follows the sample has its force ready
/// when that command is due: from sample to force goes one device period. So where kSteady ticks in a row found one
/// sample more each, about a period after the one before, the next deadline is a period after the newest sample, and the servo
/// waits for the next one from an eighth of a period before that to an eighth after it. Where no sample comes then
/// the tick is not put off longer, and for kPause there is no waiting: a device whose samples fall elsewhere costs
/// one late tick a second. A much faster device needs none of this, since its samples are young at any moment.
///
/// All times [ns].
#pragma once

#include <algorithm>
#include <cstdint>

#include "common/base/bell.h"

namespace palpate {

class TickPace {
 public:
  static constexpr int kSteady = 8;                      ///< ticks
  static constexpr std::int64_t kPause = 1'000'000'000;  ///< [ns]
  static constexpr std::int64_t kPart = 8;

  TickPace(std::int64_t period, std::int64_t start) noexcept : period_(period), due_(start + period) {}

  /// Sleep until `from`; then, where `until` is later, until a sample comes or `until`.
  struct Wait {
    std::int64_t from = 0, until = 0;
  };
  [[nodiscard]] Wait next() const noexcept {
    const std::int64_t slack = follows() ? period_ / kPart : 0;
    return {due_ - slack, due_ + slack};
  }

  /// Awake at `from`, with the newest sample: whether to wait for another.
  [[nodiscard]] bool awaits(const Bell::Rang& sample) const noexcept { return follows() && !is_due(sample); }

  /// After the wait. @return when the tick was to begin.
  std::int64_t began(const Bell::Rang& sample) noexcept {
    const Wait wait = next();
    const bool in_time = is_due(sample), one = sample.count == sample_.count + 1;
    const std::int64_t gap = sample.last - sample_.last;
    sample_ = sample;
    if (follows() && !in_time) {
      steady_ = 0;
      paused_until_ = due_ + kPause;
      return wait.until;
    }
    if (follows()) {
      // By a part of the difference: the moments of samples are uneven.
      due_ += std::clamp((sample.last - due_) / 2, -period_ / kPart, period_ / kPart);
      return std::max(sample.last, wait.from);
    }
    const bool alike = one && 4 * gap >= 3 * period_ && 4 * gap <= 5 * period_;
    if (due_ >= paused_until_) steady_ = alike ? steady_ + 1 : 0;
    return due_;
  }

  /// After the tick. @return deadlines that have passed at `now`, which are left out.
  std::int64_t ended(std::int64_t now) noexcept {
    if (steady_ == kSteady) {
      // From its own moments to those of the samples.
      due_ = sample_.last;
      ++steady_;
      if (2 * (due_ + period_ - now) < period_) due_ += period_;
    }
    due_ += period_;
    const std::int64_t behind = now - due_;
    const std::int64_t passed = behind >= 0 ? behind / period_ + 1 : 0;
    due_ += passed * period_;
    return passed;
  }

  /// Whether ticks follow the samples.
  [[nodiscard]] bool follows() const noexcept { return steady_ > kSteady; }

 private:
  [[nodiscard]] bool is_due(const Bell::Rang& sample) const noexcept {
    return sample.count != sample_.count && sample.last >= due_ - period_ / 4 && sample.last <= next().until;
  }

  std::int64_t period_;
  std::int64_t due_;
  Bell::Rang sample_;  ///< the newest known one
  std::int64_t paused_until_ = 0;
  int steady_ = 0;  ///< ticks in a row with a new sample; above kSteady: it follows
};

}  // namespace palpate
