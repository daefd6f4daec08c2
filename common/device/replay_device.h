/// Samples from memory as a device: plays a path at its own pace.
#pragma once

#include <cstddef>
#include <vector>

#include "common/device/device.h"

namespace palpate {

/// The first read() starts it; each one gives the newest sample whose time has come, with its time moved to
/// the reader's clock. There is no hand any more once the last sample is older than
/// `DeviceLimits::stale_after`.
class ReplayDevice final : public Device {
 public:
  /// @param samples in the workspace frame; those that are not finite, or not later than the one before, are
  /// left out: a device never gives such.
  explicit ReplayDevice(const std::vector<DeviceSample>& samples, const DeviceLimits& limits = {});

  bool read(double now, DeviceSample& sample) noexcept override;
  void command(const Vec3& /*force*/) noexcept override {}
  void emergency_stop() noexcept override {}
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }

 private:
  std::vector<DeviceSample> samples_;
  DeviceLimits limits_;
  std::size_t next_ = 0;
  double offset_ = 0.0;  ///< from times of the samples to those of the reader
};

}  // namespace palpate
