/// A link to a foot switch: up to three buttons, and nothing else. Made to be the dead-man switch of another
/// device (Ikits 2006, sec. 3.1): whatever goes wrong, it is released.
///
/// A HID device may speak only when something changes; a switch that is held must be heard all the time. So
/// it is told to repeat its report every kRepeat (SET_IDLE), and asked for one (GET_REPORT) where none came
/// within kAskAfter: one of both is enough. Atoms carry the time when it was heard last.
///
/// A pedal that is down when it is found, because something lies on it, counts once it was seen released.
#pragma once

#include <memory>
#include <string>

#include "common/device/driver/pedal/pedal_report.h"
#include "common/device/driver/transport/usb.h"
#include "common/device/driver_link.h"

namespace palpate {

class PedalLink final : public DriverLink {
 public:
  static constexpr unsigned kRepeatUnits = 2;              ///< of 4 ms, as SET_IDLE counts
  static constexpr double kRepeat = 0.004 * kRepeatUnits;  ///< [s]
  static constexpr double kAskAfter = 0.012;               ///< [s]
  static constexpr double kSilence = 0.035;                ///< [s] unheard for so long it is released
  static constexpr double kDumb = 0.5;                     ///< [s] unheard for so long it is of no use
  static constexpr int kMostMisses = 5;                    ///< transfers in a row that may fail

  /// `transport` outlives this.
  explicit PedalLink(UsbTransport& transport) : transport_(transport) {}
  ~PedalLink() override = default;

  bool round(const Vec3& force) noexcept override;
  [[nodiscard]] const DeviceAtoms& atoms() const noexcept override { return atoms_; }
  [[nodiscard]] const LinkStatus& status() const noexcept override { return status_; }
  [[nodiscard]] std::string advice() const override;
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }
  [[nodiscard]] std::string place() const override;

 private:
  void search() noexcept;
  /// Waits for a report, else asks for one. @return whether atoms_ are new.
  bool listen() noexcept;
  bool hear(std::span<const std::uint8_t> report) noexcept;
  bool release() noexcept;

  UsbTransport& transport_;
  DeviceLimits limits_;  ///< it shows no force
  LinkStatus status_;
  DeviceAtoms atoms_;

  std::unique_ptr<UsbConnection> connection_;
  UsbEndpoint reports_;
  PedalFormat format_ = PedalFormat::kKeyboard;
  std::string path_;
  TransferStatus refused_ = TransferStatus::kOk;
  bool seen_released_ = false;
  double heard_ = 0.0;  ///< [s] when it said something that made sense, or was opened
  int misses_ = 0;
};

}  // namespace palpate
