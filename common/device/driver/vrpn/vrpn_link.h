/// A link to a device of a VRPN server: a tracker, buttons, channels of a joystick, or an arm.
///
/// Sequence: a connection over TCP, cookies both ways, our names, then whatever the server sends; names of
/// other devices on it are nothing to this link. It is asked time and again whether it is still there.
///
/// A network is no place for a servo loop: an arm is sent the force near the hand as a local model
/// (local_field.h), which the server's own loop evaluates, some hundred times a second at most. Outside of
/// its radius there is no force, nowhere is there more than the cap, and none is sent at all unless a cap was
/// named: whether a server has an arm, and what that may be asked for, only its user knows.
///
/// The last message on any fault is a model without force. What a server does with the last model where the
/// connection itself breaks is its own affair: VRPN's takes it away.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "common/device/driver/arm_settings.h"
#include "common/device/driver/sender_clock.h"
#include "common/device/driver/shown_force.h"
#include "common/device/driver/transport/byte_stream.h"
#include "common/device/driver/vrpn/local_field.h"
#include "common/device/driver/vrpn/vrpn_message.h"
#include "common/device/driver_link.h"

namespace palpate {

/// NAME@HOST[:PORT]; an IPv6 address stands in brackets.
struct VrpnAddress {
  static constexpr std::uint16_t kPort = 3883;
  std::string name;
  std::string host;
  std::uint16_t port = kPort;
};
[[nodiscard]] std::optional<VrpnAddress> vrpn_address(std::string_view text);

struct VrpnSettings {
  VrpnAddress address;
  int sensor = 0;  ///< of the tracker
  ArmSettings arm;
  bool force = false;       ///< it is an arm, and may be sent forces
  double stiffest = 300.0;  ///< [N/m] of a model
  double radius = 0.01;     ///< [m] of a model

  static constexpr const char* kAxes = "xyz";
  VrpnSettings();
};

/// The options of `--device vrpn:NAME@HOST[:PORT],NAME=VALUE,…`. @throws Error (usage).
[[nodiscard]] VrpnSettings vrpn_settings(const DriverOptions& options);
[[nodiscard]] std::string vrpn_help();

class VrpnLink final : public DriverLink {
 public:
  static constexpr double kReadTime = 0.010;    ///< [s] that one round waits
  static constexpr double kGreetTime = 2.0;     ///< [s] within which a server must say what it is
  static constexpr double kSilence = 3.0;       ///< [s] after which a server is taken for dead
  static constexpr double kPingPause = 0.2;     ///< [s]
  static constexpr double kHush = 0.5;          ///< [s] after which nothing counts as pressed or pushed
  static constexpr double kFieldPause = 0.002;  ///< [s] between two models
  static constexpr double kFreshPose = 0.050;   ///< [s] an older pose gets no force
  static constexpr int kMostMisses = 5;         ///< poses in a row that no hand can have made

  VrpnLink(std::unique_ptr<StreamPlace> place, const VrpnSettings& settings);
  ~VrpnLink() override;

  bool round() noexcept override;
  [[nodiscard]] const DeviceAtoms& atoms() const noexcept override { return atoms_; }
  /// Of what is no arm: sensor i as station i + 1, in the server's frame.
  [[nodiscard]] const PoseAtoms* poses() const noexcept override {
    return settings_.force ? nullptr : &poses_;
  }
  [[nodiscard]] Rigid device_from_poses() const noexcept override { return settings_.arm.frame.rigid(); }
  [[nodiscard]] const LinkStatus& status() const noexcept override { return status_; }
  [[nodiscard]] std::string advice() const override;
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }
  void restrain(const DeviceLimits& asked) noexcept override { shown_.restrain(asked); }
  [[nodiscard]] std::string place() const override;

 private:
  void search() noexcept;
  void greet() noexcept;
  void speak() noexcept;
  bool listen() noexcept;
  bool take(const VrpnMessage& message, double now) noexcept;
  bool take_pose(const VrpnPose& pose, double now) noexcept;
  bool take_station(const VrpnPose& pose, double now) noexcept;
  bool send(const VrpnWriter& writer) noexcept;
  bool still() noexcept;
  [[nodiscard]] VrpnForceField field() const noexcept;
  void give_up() noexcept;
  void close() noexcept;

  std::unique_ptr<StreamPlace> place_;
  VrpnSettings settings_;
  DeviceLimits limits_;
  ShownForce shown_{limits_};
  LinkStatus status_;
  DeviceAtoms atoms_;
  PoseAtoms poses_;

  std::unique_ptr<ByteStream> stream_;
  VrpnParser parser_;
  VrpnNames names_;
  SenderClock clock_;  ///< of the poses
  LocalField local_;
  ForceRearm rearm_;
  bool greeted_ = false;
  bool pressing_ = false;    ///< the last model that was sent has a force
  double opened_at_ = 0.0;   ///< [s]
  double heard_ = 0.0;       ///< [s] when anything came
  double pinged_ = 0.0;      ///< [s]
  double sent_field_ = 0.0;  ///< [s]
  double posed_ = 0.0;       ///< [s] when a pose came
  int misses_ = 0;           ///< in a row
  std::array<std::uint8_t, 8192> received_{};
  std::array<std::uint8_t, 2048> packed_{};
};

}  // namespace palpate
