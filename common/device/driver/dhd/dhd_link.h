/// A link to a device of Force Dimension (omega, delta, sigma, lambda), worked through its maker's library.
///
/// Every round sends a force, then asks for position and buttons, a thousand times a second. The
/// device's own watchdog, where its library has one, takes the force away 20 ms after the last command: a
/// call that never comes back leaves no force.
///
/// The last command on any fault is zero. A device that switched its force off by itself gets force again
/// once none was asked for (ForceRearm). Where the calls of the library fail, or one throws, it is closed and
/// looked for again.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "common/device/driver/arm_settings.h"
#include "common/device/driver/link_clock.h"
#include "common/device/driver/shown_force.h"
#include "common/device/driver_link.h"

namespace palpate {

// Force Dimension's DHD library as far as the link uses it: what its functions are called, take and return,
// in our own words. Units m, N; -1 is an error, 0 and positive values are not.

struct DhdFunctions {
  static constexpr std::size_t kStatusCount = 17;
  using Status = std::array<int, kStatusCount>;

  void (*version)(int* major, int* minor, int* release, int* revision) = nullptr;
  int (*device_count)() = nullptr;
  int (*open)() = nullptr;  ///< the first one; its number
  int (*open_serial)(int serial) = nullptr;
  int (*close)(char id) = nullptr;
  int (*system_type)(char id) = nullptr;
  const char* (*system_name)(char id) = nullptr;
  int (*status)(int* status, char id) = nullptr;  ///< of kStatusCount
  int (*position)(double* x, double* y, double* z, char id) = nullptr;
  unsigned (*buttons)(char id) = nullptr;
  int (*enable_force)(unsigned char on, char id) = nullptr;
  int (*set_force)(double x, double y, double z, char id) = nullptr;
  double (*max_force)(char id) = nullptr;
  const char* (*last_error)() = nullptr;
  // Not in every version: null where they are missing.
  int (*enable_expert)() = nullptr;
  int (*set_watchdog)(unsigned char eighths_of_ms, char id) = nullptr;  ///< 0: none
  int (*emulate_button)(unsigned char on, char id) = nullptr;  ///< button 0 is a gripper that is closed
};

/// Opens the library by `file`, or by its usual names where that is empty, and finds its functions.
/// @throws Error (work failed) where there is none, one lacks a function, or is older than version 3.
[[nodiscard]] DhdFunctions open_dhd_library(const std::string& file);

/// What is known of a kind of device by its system type.
struct DhdModel {
  int type = 0;
  const char* name = "";
  double force = 0.0;    ///< [N] that open drivers use as its peak
  double reach = 0.0;    ///< [m] radius of its workspace
  bool gripper = false;  ///< in place of a button
};
/// The Omega's numbers for a type that is not known.
[[nodiscard]] const DhdModel& dhd_model(int type) noexcept;

struct DhdSettings {
  ArmSettings arm;
  std::string file;  ///< of the library; empty: by its usual names
  int serial = 0;    ///< of the device; 0: the first one

  static constexpr const char* kAxes = "yzx";  ///< its y points right, z up, x towards the user
  DhdSettings();
};

/// The options of `--device dhd:NAME=VALUE,…`. @throws Error (usage).
[[nodiscard]] DhdSettings dhd_settings(const DriverOptions& options);
[[nodiscard]] std::string dhd_help();

class DhdLink final : public DriverLink {
 public:
  static constexpr double kPeriod = 0.001;  ///< [s] between two rounds, at least
  static constexpr int kMostMisses = 5;     ///< calls in a row that may fail or make no sense
  static constexpr int kLastZeros = 3;
  static constexpr unsigned char kWatchdog = 160;  ///< of 1/8 ms: 20 ms

  /// @pre settings.arm.valid(). `clock` outlives this.
  DhdLink(const DhdFunctions& dhd, LinkClock& clock, const DhdSettings& settings);
  ~DhdLink() override;

  bool round() noexcept override;
  [[nodiscard]] const DeviceAtoms& atoms() const noexcept override { return atoms_; }
  [[nodiscard]] const LinkStatus& status() const noexcept override { return status_; }
  [[nodiscard]] std::string advice() const override;
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }
  void restrain(const DeviceLimits& asked) noexcept override { shown_.restrain(asked); }
  [[nodiscard]] std::string place() const override;

 private:
  // What calls the library, which may be of C++ and throw.
  bool work();
  void search();
  bool exchange();
  /// Reads what the device says of itself; false: the call failed.
  bool look();
  bool take_sample(double now);
  bool show(const Vec3& force);

  void give_up() noexcept;
  void close() noexcept;

  DhdFunctions dhd_;
  LinkClock& clock_;
  DhdSettings settings_;
  DeviceLimits limits_;
  ShownForce shown_{limits_};
  LinkStatus status_;
  DeviceAtoms atoms_;

  bool open_ = false;
  char id_ = 0;
  std::string name_;  ///< "omega.3"
  double cap_ = 0.0;  ///< [N] of the device that is open
  DhdFunctions::Status state_{};
  double looked_ = -1.0;    ///< [s]
  double round_ = 0.0;      ///< [s] when the last one began
  bool off_ = false;        ///< it has switched its force off
  bool no_button_ = false;  ///< it has a gripper, and no button
  ForceRearm rearm_;
  int misses_ = 0;  ///< in a row
};

}  // namespace palpate
