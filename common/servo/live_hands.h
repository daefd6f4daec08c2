/// Hands that a tracker sees now, each at one of its stations.
#pragma once

#include <memory>

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

}  // namespace palpate
