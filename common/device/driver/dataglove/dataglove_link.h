/// A link to a 5DT Data Glove Ultra on USB: how far its joints are bent, and a button for each finger that
/// is.
///
/// It reports all the time. Unheard for kSilence, its fingers are stretched and its buttons up.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "common/device/driver/dataglove/dataglove_report.h"
#include "common/device/driver/transport/usb.h"
#include "common/device/driver_link.h"

namespace palpate {

class DataGloveLink final : public DriverLink {
 public:
  static constexpr double kSilence = 0.1;    ///< [s]
  static constexpr double kDumb = 1.0;       ///< [s] unheard for so long it is of no use
  static constexpr double kBent = 0.6;       ///< from here on a finger's button is down,
  static constexpr double kStretched = 0.4;  ///< and up again below this
  static constexpr int kMostMisses = 5;      ///< transfers in a row that may fail

  /// `transport` outlives this.
  explicit DataGloveLink(UsbTransport& transport) : transport_(transport) {}

  bool round(const Vec3& force) noexcept override;
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
