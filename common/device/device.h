/// A device under the hand: where it is, and what force it may be told to show.
///
/// Workspace frame, metres, newtons; times are seconds of CLOCK_MONOTONIC.
#pragma once

#include <cmath>
#include <cstdint>

#include "common/math/vec.h"

namespace palpate {

/// Where the hand was.
struct DeviceSample {
  double time = 0.0;          ///< [s] when it was taken
  Vec3 position{0.0};         ///< [m]
  std::uint32_t buttons = 0;  ///< bit i: button i is down

  bool operator==(const DeviceSample&) const = default;
};

/// What a device may be asked to do. The safety stage (servo/safety_stage.h) holds every force to it.
struct DeviceLimits {
  double force_cap = 4.0;           ///< [N] largest force
  double slew_cap = 200.0;          ///< [N/s] fastest growth and turn of the force
  double velocity_gate = HUGE_VAL;  ///< [m/s] a faster hand gets no force until it is armed again
  double stale_after = 0.1;         ///< [s] an older sample gets no force
  double start_ramp = 0.0;          ///< [s] over which the cap grows from zero after a start or a fault

  bool operator==(const DeviceLimits&) const = default;

  /// Whether every value can be used: positive, the ramp zero at least; only gate and age may be infinite.
  [[nodiscard]] bool valid() const noexcept {
    return std::isfinite(force_cap) && force_cap > 0.0 && std::isfinite(slew_cap) && slew_cap > 0.0 &&
           velocity_gate > 0.0 && stale_after > 0.0 && std::isfinite(start_ramp) && start_ramp >= 0.0;
  }
};

class Device {
 public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device() = default;

  /// The newest sample that is known at the time `now`; the same one again where there is no newer one, so
  /// that its age shows. False, and `sample` untouched, where no hand is on the device. Servo thread. @rt
  /// Safe.
  virtual bool read(double now, DeviceSample& sample) noexcept = 0;
  /// The force [N] to show from now on. Servo thread. @rt Safe.
  virtual void command(const Vec3& force) noexcept = 0;
  /// Shows no force from now on, until the next command(). Any thread, also while the servo thread is inside
  /// another call.
  virtual void emergency_stop() noexcept = 0;
  /// Does not change while the device lives.
  [[nodiscard]] virtual const DeviceLimits& limits() const noexcept = 0;
};

}  // namespace palpate
