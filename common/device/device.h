/// A device under the hand: where it is, and what force it may be told to show.
///
/// Workspace frame, metres, newtons; times are seconds of CLOCK_MONOTONIC.
#pragma once

#include <cstdint>
#include <optional>

#include "common/base/bell.h"
#include "common/device/device_limits.h"
#include "common/math/vec.h"

namespace palpate {

/// Where the hand was.
struct DeviceSample {
  double time = 0.0;          ///< [s] when it was taken
  Vec3 position{0.0};         ///< [m]
  std::uint32_t buttons = 0;  ///< bit i: button i is down
  /// [m] where the hand was in the device's own frame, in which reach and velocity gate are given. None: as
  /// `position`.
  std::optional<Vec3> hand{};

  [[nodiscard]] Vec3 in_hand() const noexcept { return hand.value_or(position); }

  bool operator==(const DeviceSample&) const = default;
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
  /// What rings when there is a newer sample; null: the device is read whenever it suits, a mouse. Does not change
  /// while the device lives.
  [[nodiscard]] virtual const Bell* bell() const noexcept { return nullptr; }
  /// Does not change while the device lives.
  [[nodiscard]] virtual const DeviceLimits& limits() const noexcept = 0;
};

}  // namespace palpate
