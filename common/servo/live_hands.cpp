#include "common/servo/live_hands.h"

#include <cstddef>
#include <utility>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/servo/real_time.h"

namespace palpate {

StationPoses::StationPoses(std::shared_ptr<LinkedDevice> tracker, int station)
    : tracker_(std::move(tracker)), station_(as_size(station - 1)) {
  PALPATE_CHECK(tracker_ && tracker_->tracks());
  PALPATE_CHECK(station >= 1 && station_ < PoseAtoms::kStations);
}

bool StationPoses::next(double now, PoseSample& sample) {
  PoseAtoms poses;
  tracker_->read_poses(now, poses);
  const PoseAtom& atom = poses.stations[station_];
  if (!atom.valid) {
    // Told once, of now.
    if (std::exchange(lost_, true)) return false;
    sample = {now, std::nullopt};
    return true;
  }
  if (!(atom.time > reported_)) return false;
  lost_ = false;
  reported_ = atom.time;
  sample = {atom.time, TrackerPose{atom.position, atom.orientation}};
  return true;
}

LiveHands::LiveHands(std::shared_ptr<LinkedDevice> tracker, const HandStations& stations)
    : tracker_(std::move(tracker)), stations_(stations) {
  PALPATE_CHECK(tracker_ && tracker_->tracks());
}

bool LiveHands::read(double /*now*/, TrackedHands& hands) {
  const double now = 1e-9 * static_cast<double>(monotonic_ns());
  PoseAtoms poses;
  tracker_->read_poses(now, poses);
  const auto seen = [&poses](int station) -> const PoseAtom* {
    if (station < 1 || station > static_cast<int>(PoseAtoms::kStations)) return nullptr;
    const PoseAtom& pose = poses.stations[as_size(station - 1)];
    return pose.valid ? &pose : nullptr;
  };
  const PoseAtom* const stylus = seen(stations_.stylus);
  const PoseAtom* const other = seen(stations_.other);
  if (stylus == nullptr && other == nullptr) return false;
  hands = {.time = now};
  if (stylus != nullptr) {
    hands.stylus = TrackerPose{stylus->position, stylus->orientation};
    hands.acts = (stylus->buttons & 1U) != 0;
    hands.clutch = (stylus->buttons & 2U) != 0;
  }
  if (other != nullptr) {
    hands.other = TrackerPose{other->position, other->orientation};
    hands.carries = (other->buttons & 1U) != 0;
  }
  return true;
}

}  // namespace palpate
