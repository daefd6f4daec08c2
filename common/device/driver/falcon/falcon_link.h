/// A link to a Novint Falcon: finds it, loads its firmware, waits for it to be homed, then shows forces.
///
/// Sequence after plugging in: bridge to running speed; is there an answer to a zero command? if not, loader
/// speed, greeting, image with every byte echoed, running speed again. Then the user moves the grip out and
/// in, each encoder's zero jumps, and once all three have the position is found anew from the middle. Every
/// command is answered by the encoders; one is under way at a time.
///
/// The last command on any fault is zero: sent kLastZeros times, as it is not known whether the firmware
/// stops its motors when the host falls silent. So a small process waits beside this one, and sends it where this
/// one is killed (UsbConnection::leave_last_word()). After a fault the link opens the device again by itself;
/// whether there is force again is for the safety stage to say.
///
/// Motor command = -gain * tau. What the gain of a device is nobody has published: 3500 is the lower of what
/// the evidence allows, so forces may be too weak, not too strong. Not verified on hardware: see README.md.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/device/driver/falcon/falcon_packet.h"
#include "common/device/driver/motor_heat.h"
#include "common/device/driver/shown_force.h"
#include "common/device/driver/transport/usb.h"
#include "common/device/driver_link.h"
#include "common/kinematics/delta_arm.h"

namespace palpate {

inline constexpr UsbId kFalconId{0x0403, 0xcb48};

struct FalconSettings {
  DeltaGeometry geometry;
  double gain = 3500.0;                        ///< [counts per N m at the arm]
  double zero_angle = 0.6108652381980153;      ///< theta_1 at count 0 [rad]: 35 degrees
  double count_angle = 6.359047629780477e-04;  ///< [rad] 1280 counts a motor turn, drums 14.25 to 110 mm
  double force_cap = 8.0;                      ///< [N] whatever is asked for
  std::vector<std::uint8_t> firmware;          ///< image that the user supplied; empty: none

  static constexpr Vec3 kMiddle{0.0, 0.0, 0.125};  ///< [m] of the workspace, in the frame of the arm
  static constexpr std::size_t kLeastFirmware = 1024, kMostFirmware = 65536;  ///< [bytes]
  [[nodiscard]] bool valid() const noexcept;
};

class FalconLink final : public DriverLink {
 public:
  static constexpr int kLastZeros = 3;
  static constexpr int kMostMisses = 5;         ///< answers in a row that may be missing or make no sense
  static constexpr int kMostUploads = 10;       ///< in a row, before a pause
  static constexpr double kAnswerTime = 0.010;  ///< [s] within which a command is answered

  /// @pre settings.valid(). `transport` outlives this.
  FalconLink(UsbTransport& transport, FalconSettings settings);
  ~FalconLink() override;

  bool round() noexcept override;
  [[nodiscard]] const DeviceAtoms& atoms() const noexcept override { return atoms_; }
  [[nodiscard]] const LinkStatus& status() const noexcept override { return status_; }
  [[nodiscard]] std::string advice() const override;
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }
  void restrain(const DeviceLimits& asked) noexcept override { shown_.restrain(asked); }
  [[nodiscard]] std::string place() const override;

 private:
  enum class Stage : std::uint8_t { kSearch, kProbe, kLoad, kUpload, kRun };

  void search() noexcept;
  void probe() noexcept;
  void load() noexcept;
  void upload() noexcept;
  bool exchange() noexcept;

  bool set_running_speed() noexcept;
  bool greet_loader() noexcept;
  bool control(std::uint8_t request, std::uint16_t value) noexcept;
  bool expect(std::span<const std::uint8_t> wanted, double seconds) noexcept;

  /// Sends a command and waits for its answer.
  std::optional<FalconReply> ask(const FalconCommand& command) noexcept;
  /// What is sent for `force` now.
  [[nodiscard]] FalconCounts motors_for(const Vec3& force) noexcept;
  /// Takes an answer; false where it says nothing about a hand.
  bool take(const FalconReply& reply) noexcept;
  [[nodiscard]] bool plausible(const FalconReply& reply, double now) const noexcept;
  [[nodiscard]] Vec3 angles_of(const FalconCounts& counts) const noexcept;

  /// Of a command without force, once this program is gone.
  bool leave_last_word() noexcept;
  void send_zeros() noexcept;
  void give_up() noexcept;
  void close() noexcept;

  UsbTransport& transport_;
  FalconSettings settings_;
  DeltaArm arm_;
  DeviceLimits limits_;
  ShownForce shown_{limits_};
  LinkStatus status_;
  DeviceAtoms atoms_;

  std::unique_ptr<UsbConnection> connection_;
  std::string path_;
  TransferStatus refused_ = TransferStatus::kOk;  ///< why it could not be opened
  Stage stage_ = Stage::kSearch;
  bool guarded_ = true;  ///< nothing else is known yet
  int uploads_in_a_row_ = 0;
  std::size_t uploaded_ = 0;  ///< [bytes] of the image, echoed

  FalconReplyParser parser_;
  std::uint64_t dropped_before_ = 0;
  MotorHeat heat_;
  FalconCounts counts_{};  ///< of the last answer that was used
  Vec3 position_{0.0};     ///< in the frame of the arm
  Mat3 rates_{1.0};
  double answered_ = 0.0;   ///< [s] when it came
  double commanded_ = 0.0;  ///< [s] when the last motors_for() was
  int misses_ = 0;          ///< in a row
};

// The options of `--device falcon:NAME=VALUE,…`.

/// Reads the image of the firmware, where one is named.
/// @throws Error (usage) for an unknown name or a value out of bounds, (bad input) for a file that cannot be
/// an image.
[[nodiscard]] FalconSettings falcon_settings(const DriverOptions& options);
[[nodiscard]] std::string falcon_help();

}  // namespace palpate
