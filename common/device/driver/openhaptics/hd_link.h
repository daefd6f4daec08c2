/// A link to a PHANToM, Touch, Omni or Desktop, worked through OpenHaptics.
///
/// The library has a thread of its own that calls back a thousand times a second: there the position is read
/// and the force set. That callback and the link exchange their newest by triple buffers, so that neither
/// waits, and the callback is a watchdog of its own: an order older than kFreshFor is a force of zero.
///
/// The last command on any fault is zero. After the library reported an error (warm motors, too fast, too
/// much force) there is force again once none was asked for (ForceRearm). Where its callbacks stop coming the
/// device is closed and looked for again.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

#include "common/base/triple_buffer.h"
#include "common/device/driver/arm_settings.h"
#include "common/device/driver/link_clock.h"
#include "common/device/driver/motor_heat.h"
#include "common/device/driver/openhaptics/hd_library.h"
#include "common/device/driver_link.h"

namespace palpate {

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
  static constexpr double kFreshFor = 0.020;    ///< [s]
  static constexpr double kAnswerTime = 0.015;  ///< [s] in which a callback must come
  static constexpr int kMostMisses = 4;         ///< in a row

  /// @pre settings.arm.valid(). `clock` outlives this.
  HdLink(const HdFunctions& hd, LinkClock& clock, const HdSettings& settings);
  ~HdLink() override;

  bool round(const Vec3& force) noexcept override;
  [[nodiscard]] const DeviceAtoms& atoms() const noexcept override { return atoms_; }
  [[nodiscard]] const LinkStatus& status() const noexcept override { return status_; }
  [[nodiscard]] std::string advice() const override;
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }
  [[nodiscard]] std::string place() const override;

 private:
  struct Order {
    Vec3 force{0.0};
    double time = -1.0;  ///< [s]
  };
  struct Frame {
    double time = 0.0;  ///< [s]
    Vec3 position{0.0};
    std::array<double, DeviceAtoms::kJoints> joints{};  ///< [rad] of the arm, then of the gimbal
    std::uint32_t buttons = 0;
    unsigned error = 0;  ///< of the library, the last one
    std::uint64_t errors = 0;
    unsigned calibration = 0;
  };

  static unsigned called(void* link) noexcept { return static_cast<HdLink*>(link)->tick(); }
  /// One callback, on the library's thread.
  unsigned tick() noexcept;

  void search() noexcept;
  bool take_frame(const Frame& frame) noexcept;
  void give_up() noexcept;
  void close() noexcept;

  HdFunctions hd_;
  LinkClock& clock_;
  HdSettings settings_;
  DeviceLimits limits_;
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

  TripleBuffer<Order> orders_;
  TripleBuffer<Frame> frames_;
  std::atomic<bool> ending_{false}, ended_{true};

  // The callback's own while there is one.
  Order order_;
  Frame frame_;
  double cap_ = 0.0;  ///< [N] of the device that is open
  MotorHeat heat_{1.0, 1.0, 1.0};
};

}  // namespace palpate
