#include "common/device/calibrated_link.h"

#include <span>
#include <utility>

#include "common/base/check.h"
#include "common/base/index.h"

namespace palpate {
namespace {

bool has_joints_of(const DriverLink& link, const LinkCalibration& calibration) noexcept {
  const int joints = link.atoms().joint_count;
  return calibration.arm && joints > 0 && calibration.arm->joint_count == joints;
}

}  // namespace

bool CalibratedLink::concerns(const DriverLink& link, const LinkCalibration& calibration) noexcept {
  if (has_joints_of(link, calibration)) return true;
  return link.poses() != nullptr && (calibration.tracker || calibration.tip);
}

CalibratedLink::CalibratedLink(std::unique_ptr<DriverLink> link, LinkCalibration calibration)
    : link_(std::move(link)), calibration_(std::move(calibration)) {
  PALPATE_CHECK(link_ && concerns(*link_, calibration_));
  by_joints_ = has_joints_of(*link_, calibration_);
  if (!by_joints_) agreement_ = Agreement::kAlike;
  atoms_ = link_->atoms();
  link_->obey(this);
}

CalibratedLink::~CalibratedLink() { link_->obey(nullptr); }

Vec3 CalibratedLink::newest() noexcept {
  const Vec3 asked = ordered();
  return agreement_ == Agreement::kAlike ? asked : Vec3{0.0};
}

bool CalibratedLink::round() noexcept {
  const bool fresh = link_->round();
  if (fresh) correct();
  return fresh;
}

void CalibratedLink::correct() noexcept {
  atoms_ = link_->atoms();
  if (!atoms_.has_position) return;
  if (by_joints_) {
    const std::span<const double> readings(atoms_.joints.data(), atoms_.joint_count);
    atoms_.position = calibration_.device_from_arm * calibration_.arm->forward(readings).translation;
    compare(link_->atoms().position);
    return;
  }
  const PoseAtoms* const poses = link_->poses();
  if (poses == nullptr || atoms_.station == 0) return;
  const PoseAtom& reported = poses->stations[as_size(atoms_.station - 1)];
  TrackerPose pose{reported.position, reported.orientation};
  if (calibration_.tracker) pose = calibration_.tracker->corrected(pose);
  const Vec3 tip = pose.position + pose.orientation * calibration_.tip.value_or(Vec3{0.0});
  atoms_.position = link_->device_from_poses() * tip;
}

void CalibratedLink::compare(const Vec3& own) noexcept {
  // What was plugged in anew may be another arm.
  if (std::exchange(opened_, link_->status().opened) != link_->status().opened) {
    own_.reset();
    agreement_ = Agreement::kUnseen;
  }
  if (!own_) {
    own_ = own;
    corrected_ = atoms_.position;
    return;
  }
  const Vec3 moved = own - *own_, corrected = atoms_.position - corrected_;
  const double length = glm::length(moved), other = glm::length(corrected);
  if (length < kSeen) return;
  constexpr double kCosine = 0.866, kFactor = 2.0;  // of 30 degrees
  const bool alike = glm::dot(moved, corrected) >= kCosine * length * other && other <= kFactor * length &&
                     length <= kFactor * other;
  agreement_ = alike ? Agreement::kAlike : Agreement::kUnlike;
  own_ = own;
  corrected_ = atoms_.position;
}

std::string CalibratedLink::advice() const {
  std::string own = link_->advice();
  if (!own.empty() || link_->status().phase != LinkPhase::kReady) return own;
  switch (agreement_) {
    case Agreement::kUnseen:
      return "move the arm by some centimetres: there is force once its calibration was seen to fit";
    case Agreement::kUnlike:
      return "the calibrated arm moves another way than the device says, so there is no force: [arm] is of "
             "another arm, or arm_rotation of [interaction] is not how it stands";
    case Agreement::kAlike:
      break;
  }
  return {};
}

}  // namespace palpate
