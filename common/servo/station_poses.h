/// The poses of one station of a tracker, such as that of a head, as they come.
#pragma once

#include <memory>

#include "common/device/pose_source.h"
#include "common/servo/linked_device.h"

namespace palpate {

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
