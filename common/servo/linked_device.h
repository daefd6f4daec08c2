/// A driver's link as a device of the servo: the link is worked by a thread of its own, and both exchange
/// their newest by triple buffers, so that neither waits for the other.
///
/// Three lines of defence stand between a stalled program and a force that stays: a force that the servo has
/// not renewed for kFreshFor is zero to the link, the watchdog's emergency_stop() too, and the link itself
/// shows none without sense in its device's answers. What ends or stops the program takes the force away
/// first (force_end.h).
///
/// A dead-man switch on another device is a link on a thread of its own. Whether it is held goes into the
/// samples as a button, by its own time stamp (with_switch()): what records and replays samples has it, too.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "common/base/triple_buffer.h"
#include "common/device/device.h"
#include "common/device/device_limits.h"
#include "common/device/driver_link.h"
#include "common/servo/force_end.h"
#include "common/servo/time_histogram.h"

namespace palpate {

/// `buttons` with the bit EnablingSwitch::kOtherBit set while `button` of the other device is down and no
/// older than kEnablingStale (safety_stage.h), else cleared. @param heard null: nothing is known of the
/// other.
[[nodiscard]] std::uint32_t with_switch(std::uint32_t buttons, const DeviceAtoms* heard, int button,
                                        double now) noexcept;

class LinkedDevice final : public Device, private ForceSource {
 public:
  static constexpr double kFreshFor = 0.020;  ///< [s]
  static constexpr double kChance = 1.0;      ///< [s]
  /// [s] for which the last sample of a device that fell silent is still given, so that its age is seen as
  /// the fault that it is.
  static constexpr double kKept = 0.25;

  /// Starts the thread, and one for a switch that is on another device. @param asked caps that the user
  /// asks for, to which the link itself holds (DriverLink::restrain()). @pre link is not null.
  explicit LinkedDevice(std::shared_ptr<DriverLink> link, const EnablingSwitch& enabling = {},
                        const std::optional<DeviceLimits>& asked = {});
  /// Leaves the device without force.
  ~LinkedDevice() override;

  /// In frame D. False where there is no device, or it has no position.
  bool read(double now, DeviceSample& sample) noexcept override;
  void command(const Vec3& force) noexcept override;
  void emergency_stop() noexcept override { stopped_.store(true, std::memory_order_release); }
  [[nodiscard]] const Bell* bell() const noexcept override { return &bell_; }
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }

  /// The newest of all that the device has, at most kKept old. Servo thread, in place of read(). @rt Safe.
  bool read_atoms(double now, DeviceAtoms& atoms) noexcept;

  /// How long after its sample the link asked for each force, shared a hundred forces at a time. One thread. False
  /// where there are no more since.
  bool read_delays(TimeHistogram& delays) noexcept { return delays_out_.read(delays); }

  /// Whether it is a tracker, all its life.
  [[nodiscard]] bool tracks() const noexcept { return tracks_; }
  /// The newest poses, those that are older than kPosesKept as not valid. One thread, which need not be the
  /// servo's; the same ones again where there are no newer. @rt Safe.
  void read_poses(double now, PoseAtoms& poses) noexcept;
  static constexpr double kPosesKept = 0.1;  ///< [s] half a dozen poses of the slowest tracker

  /// @name Any thread but the servo's
  /// @{
  [[nodiscard]] LinkStatus status() const;
  /// What the user should know or do now, about the device, else about its switch; empty: nothing. That a
  /// device is not there is said once it had kChance to be found.
  [[nodiscard]] std::string advice() const;
  /// @}

 private:
  struct Order {
    Vec3 force{0.0};
    double time = 0.0;    ///< [s]
    double sample = 0.0;  ///< [s] of the sample that it answers
  };

  void work(const std::stop_token& stop);
  /// The servo's newest force, where it is fresh and may be shown.
  Vec3 newest() noexcept override;

  std::shared_ptr<DriverLink> link_;
  DeviceLimits limits_;
  std::unique_ptr<LinkedDevice> switch_;  ///< the other device; null: none
  int switch_button_ = DeviceLimits::kNoButton;
  bool tracks_ = false;
  TripleBuffer<DeviceAtoms> atoms_;
  TripleBuffer<PoseAtoms> poses_;
  TripleBuffer<Order> orders_;
  Bell bell_;
  std::atomic<bool> stopped_{false};
  std::atomic<bool> showed_{false};  ///< in the round that is under way
  ForceEnd end_;
  Order order_;  ///< of the thread that asks for forces, as the next two
  TimeHistogram delays_;
  double answered_ = 0.0;  ///< [s] the newest sample whose force was asked for
  TripleBuffer<TimeHistogram> delays_out_;

  DeviceAtoms newest_;  ///< the servo thread's
  bool seen_ = false;
  PoseAtoms newest_poses_;  ///< the reader's

  mutable std::mutex mutex_;  ///< of the next two
  LinkStatus status_;
  std::string advice_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace palpate
