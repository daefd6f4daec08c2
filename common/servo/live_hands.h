/// Hands that a tracker sees now, each at one of its stations.
#pragma once

#include <memory>

#include "common/device/pose_source.h"
#include "common/device/tracked_hands.h"
#include "common/servo/linked_device.h"

namespace palpate {

/// Stations of a tracker, from 1; 0: none.
struct HandStations {
  int stylus = 1, other = 0;
};

/// The stylus's first button acts, its second one is the clutch; the other hand's first one carries. A
/// station that is out of sight has let go of its buttons.
class LiveHands final : public HandSource {
 public:
  /// @pre the tracker tracks; its poses are read on the thread of read() alone.
  LiveHands(std::shared_ptr<LinkedDevice> tracker, const HandStations& stations);

  /// False while neither hand is in sight. The time is that of the tracker's own clock, CLOCK_MONOTONIC.
  bool read(double now, TrackedHands& hands) override;

 private:
  std::shared_ptr<LinkedDevice> tracker_;
  HandStations stations_;
};

class StationPoses final : public PoseSource {
 public:
  /// @param station from 1.
  /// @pre the tracker tracks; its poses are read on the thread of next() alone.
  StationPoses(std::shared_ptr<LinkedDevice> tracker, int station);

  /// Of all that came since the last call the newest alone. @param now [s] of CLOCK_MONOTONIC, by which times
  /// are told.
  bool next(double now, PoseSample& sample) override;
  [[nodiscard]] bool live() const override { return true; }

 private:
  std::shared_ptr<LinkedDevice> tracker_;
  std::size_t station_;    ///< from 0
  double reported_ = 0.0;  ///< time of the last pose [s]
  bool lost_ = false;      ///< that it is not seen has been told
};

}  // namespace palpate
