/// A link to a device of the 3Dconnexion SpaceMouse family: six valuators and up to 32 buttons.
///
/// While the cap is deflected it reports every 8 to 16 ms, then once that it is at rest. If that report is
/// lost, or none comes for kSilence, the valuators are zero: nothing drifts on its own.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "common/device/atoms.h"
#include "common/device/driver/transport/usb.h"
#include "common/device/driver_link.h"

namespace palpate {

// Input reports of the 3Dconnexion SpaceMouse family, by their first byte and length: models differ in both.
//
//   1, 7 bytes: push        1, 13 bytes: push and turn        2, 7 bytes: turn        3, 2 to 7 bytes:
//   buttons
//
// Numbers are signed 16-bit, little-endian; full deflection is about 350, on some models a little more.
// Anything else (0x17 comes from wireless ones) says nothing of a hand. Pure, allocates nothing.

struct SpaceMouseState {
  std::array<std::int16_t, 6> raw{};  ///< push right, towards the user, down, then turns about these
  std::uint32_t buttons = 0;          ///< the first 32 bits of the bitmap, which is sparse on some models
};

enum class SpaceMouseNews : std::uint8_t { kNothing, kAxes, kButtons };

SpaceMouseNews take_report(std::span<const std::uint8_t> report, SpaceMouseState& state) noexcept;

inline constexpr double kSpaceMouseFull = 350.0;
inline constexpr int kSpaceMouseRest = 4;  ///< counts that a cap at rest may show

/// In the axes of the suite: x right, y up, z towards the user. @param signs +1 or -1 for each.
[[nodiscard]] std::array<double, DeviceAtoms::kValuators> valuators_of(
    const SpaceMouseState& state, const std::array<double, DeviceAtoms::kValuators>& signs) noexcept;

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

  bool round() noexcept override;
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
