#include "common/device/driver/polhemus/tracker_stations.h"

#include <algorithm>
#include <cstddef>

#include "common/base/index.h"

namespace palpate {
namespace {

/// Whether a hand can have come from one to the other.
bool follows(const PoseAtom& from, const PoseAtom& to) noexcept {
  const double dt = std::max(to.time - from.time, 0.0);
  const double turned = angle_of(to.orientation * glm::conjugate(from.orientation));
  return glm::distance(from.position, to.position) <=
             TrackerStations::kLeap + TrackerStations::kMostSpeed * dt &&
         turned <= TrackerStations::kTurnedLeap + TrackerStations::kMostTurn * dt;
}

}  // namespace

TrackerStations::TrackerStations() noexcept {
  std::uint8_t number = 0;
  for (PoseAtom& pose : poses_.stations) pose.station = ++number;
}

bool TrackerStations::take(double now, const Report& report) noexcept {
  if (report.station < 1 || report.station > static_cast<int>(PoseAtoms::kStations)) return false;
  const auto index = as_size(report.station - 1);
  PoseAtom& pose = poses_.stations[index];
  Doubtful& doubtful = doubtful_[index];
  if (!report.good) {
    pose.valid = false;
    pose.buttons = 0;
    doubtful.waits = false;
    return true;
  }
  const PoseAtom said{.time = now,
                      .position = report.position,
                      .orientation = report.orientation,
                      .buttons = report.button ? 1U : 0U,
                      .station = pose.station,
                      .valid = true};
  // The first one after a while has none to be compared with, and is as likely to be damaged.
  const bool expected = pose.valid && now - pose.time <= kGap && follows(pose, said);
  const bool confirmed = doubtful.waits && now - doubtful.pose.time <= kGap && follows(doubtful.pose, said);
  doubtful = {said, !expected && !confirmed};
  if (doubtful.waits) return false;
  pose = said;
  return true;
}

bool TrackerStations::expire(double now) noexcept {
  bool any = false;
  for (PoseAtom& pose : poses_.stations) {
    if (!pose.valid || now - pose.time <= kSilence) continue;
    pose.valid = false;
    pose.buttons = 0;
    any = true;
  }
  return any;
}

void TrackerStations::lose_all() noexcept {
  for (PoseAtom& pose : poses_.stations) {
    pose.valid = false;
    pose.buttons = 0;
  }
  doubtful_ = {};
}

std::uint32_t TrackerStations::buttons() const noexcept {
  std::uint32_t buttons = 0;
  for (const PoseAtom& pose : poses_.stations) {
    if (pose.buttons != 0) buttons |= 1U << (pose.station - 1U);
  }
  return buttons;
}

}  // namespace palpate
