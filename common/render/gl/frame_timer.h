/// What frames take: by the driver's timer queries where these hold against the clock, else by the clock.
///
/// Symbols. c time of a frame by the clock, from the first command until all of it is drawn; q time that the
/// timer query tells, both in ms.
///
/// The GPU's work is part of what the clock sees, so q <= c, and where the GPU sets the pace q is most of c.
/// Some drivers tell a part of it only (a software rasteriser: a 25th, or nothing). Queries hold where
///   kLeast c <= q <= kMost c
/// in kShare of the last kFrames frames. Then q stands even for a frame that other programs held up, c being
/// large; only where it is no time, or more than c, c does.
#pragma once

#include <array>
#include <cstddef>

#include "common/base/clock.h"
#include "common/render/gl/object.h"

namespace palpate {

/// Whether timer queries of a driver can be believed. Plain arithmetic.
class TimerCheck {
 public:
  static constexpr std::size_t kFrames = 16;
  static constexpr double kShare = 0.75;               ///< of the last frames
  static constexpr double kLeast = 0.9, kMost = 1.05;  ///< q / c

  /// A frame. @return what it took: q or c [ms]
  double add(double query, double clock) noexcept;
  [[nodiscard]] bool holds() const noexcept;

 private:
  std::array<bool, kFrames> agreed_{};
  std::size_t frames_ = 0;  ///< so far
};

/// Times the commands between begin() and finish(). Needs the same context for all calls.
class FrameTimer {
 public:
  /// No other query of elapsed time may be running, but for that of a frame that was never finished.
  void begin();
  /// Waits until all is drawn. @return c [ms]
  double finish();
  /// Leaves a frame to be drawn without waiting for it, and untimed: another one may begin.
  void leave();
  /// What the last frame that was finished took [ms].
  [[nodiscard]] double milliseconds() const noexcept { return milliseconds_; }
  /// Whether it was told by a timer query.
  [[nodiscard]] bool by_query() const noexcept { return check_.holds(); }

 private:
  GlQuery query_;
  bool running_ = false;
  Stopwatch clock_;
  TimerCheck check_;
  double milliseconds_ = 0.0;
};

}  // namespace palpate
