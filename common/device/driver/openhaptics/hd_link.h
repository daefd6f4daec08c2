/// A link to a PHANToM, Touch, Omni or Desktop, worked through OpenHaptics.
///
/// The library has a thread of its own that calls back a thousand times a second: there the position is read
/// and the force set. That callback and the link exchange their newest by triple buffers, so that neither
/// waits, and the callback is a watchdog of its own: an order older than kFreshFor is a force of zero.
///
/// The last command on any fault is zero. After the library reported an error (warm motors, too fast, too
/// much force) there is force again once none was asked for (ForceRearm). Where its callbacks stop coming, or
/// one of its functions throws, the device is closed and looked for again.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

#include "common/base/triple_buffer.h"
#include "common/device/driver/arm_settings.h"
#include "common/device/driver/link_clock.h"
#include "common/device/driver/motor_heat.h"
#include "common/device/driver/shown_force.h"
#include "common/device/driver_link.h"

namespace palpate {

// The HD part of OpenHaptics as far as the link uses it, in our own words. Units mm, N.

/// What hdGetError() gives by value.
struct HdError {
  unsigned code = 0;  ///< 0: none
  int internal = 0;
  unsigned device = 0;
};

using HdCallback = unsigned (*)(void* user);  ///< 1: call it again in the next tick, 0: it is done

struct HdFunctions {
  static constexpr unsigned kNoDevice = 0xFFFFFFFF;
  static constexpr unsigned kDone = 0, kAgain = 1;
  // What is asked for and set.
  static constexpr unsigned kButtons = 0x2000, kPosition = 0x2050, kModel = 0x2501, kJointAngles = 0x2100,
                            kGimbalAngles = 0x2150, kCalibrationStyle = 0x2555, kNominalForce = 0x2603,
                            kNominalLastingForce = 0x2604, kForce = 0x2700, kForceOutput = 0x4000,
                            kForceClamping = 0x4001;
  static constexpr unsigned kCalibrated = 0x5000, kCalibrationUpdates = 0x5001;
  static constexpr unsigned short kMostImportant = 65535;

  unsigned (*init)(const char* name) = nullptr;  ///< null: the default device
  void (*disable_device)(unsigned device) = nullptr;
  void (*make_current)(unsigned device) = nullptr;
  void (*enable)(unsigned what) = nullptr;
  void (*disable)(unsigned what) = nullptr;
  void (*begin_frame)(unsigned device) = nullptr;
  void (*end_frame)(unsigned device) = nullptr;
  void (*get_doubles)(unsigned what, double* values) = nullptr;
  void (*get_integers)(unsigned what, int* values) = nullptr;
  const char* (*get_string)(unsigned what) = nullptr;
  void (*set_doubles)(unsigned what, const double* values) = nullptr;
  HdError (*error)() = nullptr;
  void (*start_scheduler)() = nullptr;
  void (*stop_scheduler)() = nullptr;
  unsigned long (*schedule)(HdCallback callback, void* user, unsigned short priority) = nullptr;
  void (*unschedule)(unsigned long handle) = nullptr;
  unsigned (*check_calibration)() = nullptr;
  void (*update_calibration)(unsigned style) = nullptr;
};

/// Opens the library by `file`, or by its usual name where that is empty, and finds its functions.
/// @throws Error (work failed) where there is none, or one lacks a function.
[[nodiscard]] HdFunctions open_hd_library(const std::string& file);

struct HdSettings {
  ArmSettings arm;
  std::string file;  ///< of the library; empty: by its usual names
  std::string name;  ///< of the device as its driver has it; empty: the default one

  static constexpr const char* kAxes = "xyz";
  HdSettings();
};

/// The options of `--device openhaptics:NAME=VALUE,…`. @throws Error (usage).
[[nodiscard]] HdSettings hd_settings(const DriverOptions& options);
[[nodiscard]] std::string hd_help();

class HdLink final : public DriverLink {
 public:
  static constexpr double kFreshFor = 0.020;    ///< [s] without a round after which there is no force
  static constexpr double kAnswerTime = 0.015;  ///< [s] in which a callback must come
  static constexpr int kMostMisses = 4;         ///< in a row

  /// @pre settings.arm.valid(). `clock` outlives this.
  HdLink(const HdFunctions& hd, LinkClock& clock, const HdSettings& settings);
  ~HdLink() override;

  bool round() noexcept override;
  [[nodiscard]] const DeviceAtoms& atoms() const noexcept override { return atoms_; }
  [[nodiscard]] const LinkStatus& status() const noexcept override { return status_; }
  [[nodiscard]] std::string advice() const override;
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }
  void restrain(const DeviceLimits& asked) noexcept override { shown_.restrain(asked); }
  [[nodiscard]] std::string place() const override;

 private:
  struct Frame {
    double time = 0.0;  ///< [s]
    Vec3 position{0.0};
    std::array<double, DeviceAtoms::kJoints> joints{};  ///< [rad] of the arm, then of the gimbal
    std::uint32_t buttons = 0;
    unsigned error = 0;  ///< of the library, the last one
    std::uint64_t errors = 0;
    unsigned calibration = 0;
  };

  static unsigned called(void* link) noexcept;

  // What calls the library, which may be of C++ and throw.
  /// One callback, on the library's thread.
  unsigned tick();
  bool work();
  void search();

  bool take_frame(const Frame& frame) noexcept;
  void give_up() noexcept;
  void close() noexcept;

  HdFunctions hd_;
  LinkClock& clock_;
  HdSettings settings_;
  DeviceLimits limits_;
  ShownForce shown_{limits_};
  LinkStatus status_;
  DeviceAtoms atoms_;

  unsigned device_ = HdFunctions::kNoDevice;
  unsigned refused_ = 0;  ///< the library's code, why it could not be opened
  std::string model_;
  unsigned long handle_ = 0;
  std::uint64_t errors_ = 0;  ///< of the callback that are known
  unsigned error_ = 0;
  ForceRearm rearm_;
  int misses_ = 0;  ///< in a row

  TripleBuffer<Frame> frames_;
  std::atomic<bool> ending_{false}, ended_{true};
  std::atomic<bool> ready_{false};   ///< there may be force
  std::atomic<double> heard_{-1.0};  ///< [s] when the link's own thread was last at work

  // The callback's own while there is one.
  Frame frame_;
  double cap_ = 0.0;  ///< [N] of the device that is open
  MotorHeat heat_{1.0, 1.0, 1.0};
};

}  // namespace palpate
