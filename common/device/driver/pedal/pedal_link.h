/// A link to a foot switch: up to three buttons, and nothing else. Made to be the dead-man switch of another
/// device (Ikits 2006, sec. 3.1): whatever goes wrong, it is released.
///
/// A HID device may speak only when something changes; a switch that is held must be heard all the time. So
/// it is told to repeat its report every kRepeat (SET_IDLE), and asked for one (GET_REPORT) where none came
/// within kAskAfter: one of both is enough. Atoms carry the time when it was heard last.
///
/// A pedal that is down when it is found, because something lies on it, counts once it was seen released.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "common/device/driver/transport/usb.h"
#include "common/device/driver_link.h"

namespace palpate {

// Input reports of foot switches. Pure, allocates nothing.
//
//   kXKeys      0, 1, bits 1 left, 2 middle, 3 right of byte 2
//   kInfinity   2 bytes: bits 0 left, 1 middle, 2 right of the first
//   kKeyboard   8 bytes, a keyboard's: modifiers, 0, the usages of up to six keys. Pedals of this kind type
//               what they were set up for, as delivered a, b, c from the left
//
// As buttons: 0 left, 1 middle, 2 right. A switch that a hand is guarded by counts as released in a report
// that makes no sense.

enum class PedalFormat : std::uint8_t { kXKeys, kInfinity, kKeyboard };

/// Bit i: pedal i is down. On a keyboard a key other than b and c is the first pedal. Nothing for a report of
/// another length, with bits or keys that no pedal has, or of a keyboard that cannot tell its keys apart.
[[nodiscard]] std::optional<std::uint32_t> pedals_of(PedalFormat format,
                                                     std::span<const std::uint8_t> report) noexcept;

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

  bool round() noexcept override;
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
