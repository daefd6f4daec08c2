/// Where poses of one tracked sensor come from: a recording, or a tracker. What follows a head does not know
/// which.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/kinematics/tracker_correction.h"

namespace palpate {

struct PoseSample {
  double time = 0.0;                ///< [s] of the reader's clock, when the tracker says that it was taken
  std::optional<TrackerPose> pose;  ///< as reported; none: the sensor was not seen
};

/// One thread.
class PoseSource {
 public:
  PoseSource() = default;
  PoseSource(const PoseSource&) = delete;
  PoseSource& operator=(const PoseSource&) = delete;
  virtual ~PoseSource() = default;

  /// The next sample of those that have come until `now` [s], of a steady clock: each once, in order. False
  /// where none is left.
  virtual bool next(double now, PoseSample& sample) = 0;
  /// Whether others may come.
  [[nodiscard]] virtual bool live() const = 0;
};

/// A recording at its own pace, from the first next() on.
class ReplayPoses final : public PoseSource {
 public:
  /// @param poses whose times rise.
  explicit ReplayPoses(std::vector<PoseSample> poses) : poses_(std::move(poses)) {}
  bool next(double now, PoseSample& sample) override;
  [[nodiscard]] bool live() const override { return next_ < poses_.size(); }

 private:
  std::vector<PoseSample> poses_;
  std::size_t next_ = 0;
  double offset_ = 0.0;  ///< from times of the recording to those of the reader
};

/// A sensor that is not moved: a head that is where it is said to be.
class RestingPose final : public PoseSource {
 public:
  explicit RestingPose(const TrackerPose& pose) : pose_(pose) {}
  bool next(double now, PoseSample& sample) override {
    if (given_ && !(now > *given_)) return false;
    given_ = now;
    sample = {now, pose_};
    return true;
  }
  [[nodiscard]] bool live() const override { return false; }

 private:
  TrackerPose pose_;
  std::optional<double> given_;  ///< when
};

/// The table `t,x,y,z,qw,qx,qy,qz`: seconds, place [m] and unit quaternion in the tracker's frame; `nan`
/// where the sensor was not seen.
/// @throws Error (bad input) naming the file, the line and what was expected: numbers, quaternions of unit
/// length, times that rise, at least one row.
[[nodiscard]] std::vector<PoseSample> read_poses(const std::string& file);

class CsvReader;
/// A pose from seven numbers of a row, `x,y,z,qw,qx,qy,qz`; none where one of them is nan.
/// @throws Error (bad input) for places that are not finite and quaternions of another length than 1.
[[nodiscard]] std::optional<TrackerPose> pose_of_row(const CsvReader& table, const double* values);

}  // namespace palpate
