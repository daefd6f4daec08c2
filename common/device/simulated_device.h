/// A simulated arm and hand as a device: to use without hardware, and to see what a loop does to both.
///
/// The operator follows another device, the leader: a mouse, or a path from memory. Where that has no hand,
/// they wander. The arm lives in the time of its readers: nothing moves between two calls of read(), so a run
/// in simulated time (probe) and one by the clock (the servo) are one code, and equal times give equal bits.
#pragma once

#include <atomic>
#include <optional>

#include "common/device/device.h"
#include "common/device/device_profile.h"
#include "common/device/hand_model.h"
#include "common/device/simulated_arm.h"

namespace palpate {

/// A path that never repeats: a sine of its own period on each axis, about `center`.
struct WanderingPath {
  Vec3 center{0.0};  ///< [m]
  Vec3 reach{0.0};   ///< [m] amplitudes

  [[nodiscard]] Vec3 at(double time) const noexcept;
};

struct SimulatedDeviceOptions {
  DeviceProfile profile;
  HandImpedance hand = kRelaxedHand;
  OperatorSettings operator_settings;
  std::optional<WanderingPath> wander;  ///< none: no hand where the leader has none
  DeviceLimits limits;
};

class SimulatedDevice final : public Device {
 public:
  /// @param leader outlives this one; its samples are where the operator wants to be. @pre the profile and
  /// the limits are valid().
  SimulatedDevice(const SimulatedDeviceOptions& options, Device& leader);

  /// The arm is simulated up to `now`. The sample is of the instant that the sensors show.
  bool read(double now, DeviceSample& sample) noexcept override;
  void command(const Vec3& force) noexcept override;
  void emergency_stop() noexcept override { stopped_.store(true, std::memory_order_release); }
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return options_.limits; }

  /// @name For reports; on the thread that reads
  /// @{
  [[nodiscard]] const std::optional<SimulatedArm>& arm() const noexcept { return arm_; }
  /// What the operator was shown last [m].
  [[nodiscard]] const Vec3& target() const noexcept { return target_; }
  /// @}

 private:
  SimulatedDeviceOptions options_;
  Device& leader_;
  Operator operator_;
  std::optional<SimulatedArm> arm_;  ///< none before the first target
  Vec3 target_{0.0};
  double now_ = 0.0;
  std::atomic<bool> stopped_{false};
};

}  // namespace palpate
