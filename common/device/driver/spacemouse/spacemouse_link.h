/// A link to a device of the 3Dconnexion SpaceMouse family: six valuators and up to 32 buttons.
///
/// While the cap is deflected it reports every 8 to 16 ms, then once that it is at rest. If that report is
/// lost, or none comes for kSilence, the valuators are zero: nothing drifts on its own.
#pragma once

#include <memory>
#include <string>

#include "common/device/driver/spacemouse/spacemouse_report.h"
#include "common/device/driver/transport/usb.h"
#include "common/device/driver_link.h"

namespace palpate {

struct SpaceMouseSettings {
  /// +1 or -1 for each valuator. Which way a model turns is not verified on hardware.
  std::array<double, DeviceAtoms::kValuators> signs{1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
};

/// The options of `--device spacemouse:invert=LETTERS`: x, y, z pushes, a, b, c the turns about them.
/// @throws Error (usage).
[[nodiscard]] SpaceMouseSettings spacemouse_settings(const DriverOptions& options);
[[nodiscard]] std::string spacemouse_help();

class SpaceMouseLink final : public DriverLink {
 public:
  static constexpr double kSilence = 0.050;  ///< [s]
  static constexpr int kMostMisses = 5;      ///< transfers in a row that may fail

  /// `transport` outlives this.
  SpaceMouseLink(UsbTransport& transport, const SpaceMouseSettings& settings);
  ~SpaceMouseLink() override;

  bool round(const Vec3& force) noexcept override;
  [[nodiscard]] const DeviceAtoms& atoms() const noexcept override { return atoms_; }
  [[nodiscard]] const LinkStatus& status() const noexcept override { return status_; }
  [[nodiscard]] std::string advice() const override;
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }
  [[nodiscard]] std::string place() const override;

 private:
  void search() noexcept;
  void light(bool on) noexcept;
  void close() noexcept;
  void publish(double now) noexcept;

  UsbTransport& transport_;
  SpaceMouseSettings settings_;
  DeviceLimits limits_;  ///< it shows no force
  LinkStatus status_;
  DeviceAtoms atoms_;

  std::unique_ptr<UsbConnection> connection_;
  UsbEndpoint reports_;
  std::string path_;
  TransferStatus refused_ = TransferStatus::kOk;
  SpaceMouseState state_;
  double heard_ = 0.0;  ///< [s] when axes were reported last
  int misses_ = 0;
};

}  // namespace palpate
