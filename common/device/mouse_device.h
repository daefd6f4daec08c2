/// A mouse as a device: positions arrive at the frame rate of a window, the servo reads them at its own.
///
/// Between targets the position moves in a straight line, at constant speed:
///
///   x(t) = x_s + (x_k - x_s) min(1, (t - t_s) / T),   T = t_k - t_(k-1) in [kShortest, kLongest]
///
/// where x_k is the newest target, set at t_k, and x_s the position at the time t_s when the servo first saw
/// it. So the position never steps and never passes a target, and lags behind the hand by one interval of the
/// window's frames (16 ms at 60 Hz) at most kLongest.
#pragma once

#include <cstdint>

#include "common/base/triple_buffer.h"
#include "common/device/device.h"

namespace palpate {

class MouseDevice final : public Device {
 public:
  static constexpr double kShortest = 0.001;  ///< [s]
  static constexpr double kLongest = 0.050;   ///< [s] slower windows jerk instead of lagging further behind

  explicit MouseDevice(const DeviceLimits& limits = {}) : limits_(limits) {}

  // Window thread, wait-free. `time` [s] is of any steady clock, the same for all calls.

  /// Takes hold: samples begin at `position` at once. Where it was held already the hand is off the probe for
  /// a step, so that nothing is pulled along.
  void grab(double time, const Vec3& position, std::uint32_t buttons) noexcept;
  /// Where the hand is to be, once a frame while it is held, moved or not; nothing while it is not.
  void move(double time, const Vec3& target, std::uint32_t buttons) noexcept;
  /// There are no samples until the next grab().
  void let_go() noexcept;
  [[nodiscard]] bool grabbed() const noexcept { return newest_.grabbed; }

  // Servo thread.

  bool read(double now, DeviceSample& sample) noexcept override;
  void command(const Vec3& /*force*/) noexcept override {}  // a mouse shows none
  void emergency_stop() noexcept override {}
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }

 private:
  struct Target {
    Vec3 position{0.0};
    double time = 0.0;
    std::uint32_t buttons = 0;
    std::uint32_t grabs = 0;  ///< counts: a new grab starts where it is, not where the last one ended
    bool grabbed = false;
  };

  [[nodiscard]] Vec3 position_at(double now) const noexcept;

  DeviceLimits limits_;
  Target newest_;  ///< window thread
  TripleBuffer<Target> targets_;

  Target target_;            ///< servo thread, as all below
  Vec3 start_{0.0};          ///< x_s
  double start_time_ = 0.0;  ///< t_s
  double interval_ = kShortest;
};

}  // namespace palpate
