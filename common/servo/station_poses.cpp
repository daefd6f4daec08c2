#include "common/servo/station_poses.h"

#include <utility>

#include "common/base/check.h"
#include "common/base/index.h"

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

}  // namespace palpate
