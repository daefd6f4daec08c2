/// The dead-man switch of a device that shows force (Ikits 2006, sec. 3.1): there is force only while it is
/// held. It is a button of the device itself, or of another one, such as a pedal.
#pragma once

#include <memory>

#include "common/device/driver_link.h"

namespace palpate {

struct EnablingSwitch {
  int button = DeviceLimits::kNoButton;  ///< of the device, or of the one of `link`; kNoButton: none needed
  std::shared_ptr<DriverLink> link;      ///< of the device that has the button; null: the device itself

  /// The bit of a sample that says whether the button of another device is held: see linked_device.h.
  static constexpr int kOtherBit = DeviceLimits::kButtons - 1;

  /// The button of the samples that the safety stage looks at.
  [[nodiscard]] int sample_button() const noexcept { return link ? kOtherBit : button; }
};

}  // namespace palpate
