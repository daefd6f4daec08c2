/// A link whose device tells where its calibration says that it is, not where it says itself.
///
/// Symbols. theta readings of an arm's joints [rad], T(theta) its end in its frame 0 by the calibrated chain
/// (dhh_chain.h), B where frame 0 lies in D; (p, q) the pose of a tracker's sensor, corrected (
/// tracker_correction.h), u the tip of what carries it in the sensor's frame, M where the tracker's frame
/// lies in D.
///
///   x_D = B(T(theta) 0)   of an arm that tells its joints                                            (1)
///   x_D = M(p + R(q) u)   of a tracker whose sensor moves the probe by itself                         (2)
///
/// (1) is Ikits 2006, sec. 4.3, where positions of the PHANToM come from its calibrated chain. Poses stay as
/// they are reported: whoever uses them corrects them.
///
/// A force goes to the arm in frame D as it is. Its maker turns it into torques by a Jacobian of its own,
/// which is as wrong as the maker's angles, some degrees: its direction is off by so much.
///
/// An arm gets no force until its corrected positions were seen to move as its own do: over kSeen of motion
/// both directions must agree within 30 degrees and lengths within a factor of two. A chain of another arm,
/// or a frame that lies another way, would push the hand where nothing is felt.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "common/device/driver_link.h"
#include "common/kinematics/dhh_chain.h"
#include "common/kinematics/tracker_correction.h"

namespace palpate {

struct LinkCalibration {
  std::optional<TrackerCorrection> tracker;
  std::optional<Vec3> tip;  ///< u [m]
  std::optional<DhhChain> arm;
  Rigid device_from_arm;  ///< B
};

class CalibratedLink final : public DriverLink, private ForceSource {
 public:
  static constexpr double kSeen = 0.02;  ///< [m]

  /// Whether the calibration says anything about such a device.
  [[nodiscard]] static bool concerns(const DriverLink& link, const LinkCalibration& calibration) noexcept;

  /// @pre link is not null, and concerns() holds.
  CalibratedLink(std::unique_ptr<DriverLink> link, LinkCalibration calibration);
  ~CalibratedLink() override;

  bool round() noexcept override;
  [[nodiscard]] const DeviceAtoms& atoms() const noexcept override { return atoms_; }
  [[nodiscard]] const PoseAtoms* poses() const noexcept override { return link_->poses(); }
  [[nodiscard]] Rigid device_from_poses() const noexcept override { return link_->device_from_poses(); }
  [[nodiscard]] const LinkStatus& status() const noexcept override { return link_->status(); }
  [[nodiscard]] std::string advice() const override;
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return link_->limits(); }
  void restrain(const DeviceLimits& asked) noexcept override { link_->restrain(asked); }
  [[nodiscard]] std::string place() const override { return link_->place(); }

 private:
  /// Whether both have been seen to move alike, or not.
  enum class Agreement : std::uint8_t { kUnseen, kAlike, kUnlike };

  Vec3 newest() noexcept override;
  void correct() noexcept;
  void compare(const Vec3& own) noexcept;

  std::unique_ptr<DriverLink> link_;
  LinkCalibration calibration_;
  DeviceAtoms atoms_;
  bool by_joints_;  ///< by (1), else by (2)

  std::atomic<Agreement> agreement_{Agreement::kUnseen};
  std::uint64_t opened_ = 0;  ///< the connection that the next two are of
  std::optional<Vec3> own_;   ///< where the arm said that it was [m]
  Vec3 corrected_{0.0};       ///< where it was then
};

}  // namespace palpate
