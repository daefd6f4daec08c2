/// A link to a 5DT Data Glove Ultra on USB: how far its joints are bent, and a button for each finger that
/// is.
///
/// It reports all the time. Unheard for kSilence, its fingers are stretched and its buttons up.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "common/device/driver/transport/usb.h"
#include "common/device/driver_link.h"

namespace palpate {

// Reports of the 5DT Data Glove Ultra on USB: 64 bytes, the first 32 of which are sixteen numbers of two
// bytes, the high one first, up to 4096. Pure, allocates nothing.
//
// The product id says what a glove is: bit 0 a left hand, bit 4 five sensors, one a finger; else fourteen,
// of which those of the fingers' first joints stand where a glove of five has its own.

struct GloveModel {
  std::uint16_t product = 0;

  [[nodiscard]] bool left() const noexcept { return (product & 0x0001U) != 0; }
  [[nodiscard]] bool five() const noexcept { return (product & 0x0010U) != 0; }
  [[nodiscard]] std::size_t sensors() const noexcept { return five() ? 5 : 14; }
};

inline constexpr std::size_t kGloveNumbers = 16;
inline constexpr std::array<std::size_t, 5> kFirstJoints{0, 3, 6, 9, 12};  ///< thumb to little finger

/// All numbers as parts of full scale, in [0, 1]; none of a report that is none.
[[nodiscard]] std::optional<std::array<double, kGloveNumbers>> glove_numbers(
    std::span<const std::uint8_t> report) noexcept;

/// The range of one sensor on the hand that wears it, which its fists and flat hands teach.
class BendRange {
 public:
  static constexpr double kLeast = 0.1;  ///< of full scale: less has taught nothing yet

  /// Where `part` is within the range, 0 to 1. The range grows by what two readings in a row agree on, so
  /// that one that was damaged does not spoil it.
  [[nodiscard]] double bend(double part) noexcept;

 private:
  double before_ = -1.0, lower_ = 1.0, upper_ = 0.0;
};

class DataGloveLink final : public DriverLink {
 public:
  static constexpr double kSilence = 0.1;    ///< [s]
  static constexpr double kDumb = 1.0;       ///< [s] unheard for so long it is of no use
  static constexpr double kBent = 0.6;       ///< from here on a finger's button is down,
  static constexpr double kStretched = 0.4;  ///< and up again below this
  static constexpr int kMostMisses = 5;      ///< transfers in a row that may fail

  /// `transport` outlives this.
  explicit DataGloveLink(UsbTransport& transport) : transport_(transport) {}

  bool round() noexcept override;
  [[nodiscard]] const DeviceAtoms& atoms() const noexcept override { return atoms_; }
  [[nodiscard]] const LinkStatus& status() const noexcept override { return status_; }
  [[nodiscard]] std::string advice() const override;
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }
  [[nodiscard]] std::string place() const override { return path_.empty() ? path_ : "usb " + path_; }

 private:
  void search() noexcept;
  void take(const std::array<double, kGloveNumbers>& numbers) noexcept;
  /// @return whether the hand was anything but open.
  bool release() noexcept;

  UsbTransport& transport_;
  DeviceLimits limits_;  ///< it shows no force
  LinkStatus status_;
  DeviceAtoms atoms_;
  std::unique_ptr<UsbConnection> connection_;
  UsbEndpoint reports_;
  GloveModel model_;
  std::string path_;
  TransferStatus refused_ = TransferStatus::kOk;
  std::array<BendRange, kGloveNumbers> ranges_{};
  double heard_ = 0.0;  ///< [s]
  int misses_ = 0;
};

}  // namespace palpate
