/// A link to a Haply Inverse3 through its maker's local service.
///
/// The service pushes all that it has when it is connected to, then answers every command with one state: the
/// rate of commands is the rate of the servo. One command is under way at a time. Where no state comes within
/// kAnswerTime a command of zero is sent; after some of these the connection is closed, upon which the
/// service lets the device idle, as it does by itself when it hears nothing. A device whose status says that it is
/// not calibrated, or has no power, shows no force.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/device/driver/arm_settings.h"
#include "common/device/driver/inverse3/inverse3_message.h"
#include "common/device/driver/shown_force.h"
#include "common/device/driver/transport/web_transport.h"
#include "common/device/driver_link.h"

namespace palpate {

struct Inverse3Settings {
  ArmSettings arm;
  WebAddress service{"localhost", 10001};
  std::string device;                     ///< its name in the service; empty: the first one
  std::optional<HaplySpelling> spelling;  ///< none: by the version that the service states

  static constexpr const char* kAxes = "xz-y";          ///< its x points right, z up, y away from the user
  static constexpr std::uint16_t kVersionPort = 10000;  ///< where it states its version, on any host
  Inverse3Settings();
};

/// The options of `--device inverse3:NAME=VALUE,…`. @throws Error (usage).
[[nodiscard]] Inverse3Settings inverse3_settings(const DriverOptions& options);
[[nodiscard]] std::string inverse3_help();

class Inverse3Link final : public DriverLink {
 public:
  static constexpr double kPeriod = 0.001;      ///< [s] between two commands, at least
  static constexpr double kAnswerTime = 0.015;  ///< [s] within which a command is answered
  static constexpr int kMostMisses = 4;         ///< answers in a row that may be missing or make no sense

  /// @pre settings.arm.valid(). `transport` outlives this.
  Inverse3Link(WebTransport& transport, const Inverse3Settings& settings);
  ~Inverse3Link() override;

  bool round() noexcept override;
  [[nodiscard]] const DeviceAtoms& atoms() const noexcept override { return atoms_; }
  [[nodiscard]] const LinkStatus& status() const noexcept override { return status_; }
  [[nodiscard]] std::string advice() const override;
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }
  void restrain(const DeviceLimits& asked) noexcept override { shown_.restrain(asked); }
  [[nodiscard]] std::string place() const override;

 private:
  void search() noexcept;
  void meet() noexcept;
  bool exchange() noexcept;
  bool send(const Vec3& force) noexcept;
  /// Waits for the newest of the states that are under way; false: none came.
  bool hear(HaplyState& state) noexcept;
  bool take(const HaplyState& state, double now) noexcept;
  void learn(const HaplyState& state) noexcept;
  void give_up() noexcept;
  void close() noexcept;

  WebTransport& transport_;
  Inverse3Settings settings_;
  DeviceLimits limits_;
  ShownForce shown_{limits_};
  LinkStatus status_;
  DeviceAtoms atoms_;

  std::unique_ptr<WebConnection> connection_;
  std::optional<HaplyId> device_;  ///< none: not met yet
  HaplySpelling spelling_ = HaplySpelling::kVector;
  bool alone_ = false;                       ///< the service is there, and has no such device
  bool ended_ = false;                       ///< the other side has closed
  double meeting_ = 0.0;                     ///< [s] when it was connected to
  double round_ = 0.0;                       ///< [s] when the last one began
  int under_way_ = 0;                        ///< commands without a state
  int misses_ = 0;                           ///< in a row
  bool calibrated_ = true, powered_ = true;  ///< as the device's status has it; true: nothing is known
  bool grip_ = false;                        ///< a grip was seen
  bool forced_ = false;                      ///< a force was asked for: something is held
  std::string sent_, heard_;
};

}  // namespace palpate
