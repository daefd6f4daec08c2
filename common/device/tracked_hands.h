/// Two tracked hands: a stylus in one, a sensor in the other. What an immersive workbench has in place of a
/// mouse.
///
/// The table of a recording, `t,x,y,z,qw,qx,qy,qz[,b0][,b1][,hx,hy,hz,hqw,hqx,hqy,hqz][,h0]
/// [,headx,heady,headz,headqw,headqx,headqy,headqz]`: seconds; place [m] and unit quaternion of the stylus's
/// sensor in the tracker's frame; its buttons, of which b0 acts and b1 is the clutch; place and quaternion of
/// the other hand's sensor, and its button; those of the head's sensor. `nan` where a sensor was not seen.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/device/pose_source.h"
#include "common/kinematics/tracker_correction.h"

namespace palpate {

struct TrackedHands {
  double time = 0.0;                  ///< [s]
  std::optional<TrackerPose> stylus;  ///< as reported; none: not seen
  std::optional<TrackerPose> other;
  bool acts = false;     ///< the stylus's button: takes hold
  bool clutch = false;   ///< its other one: the hand moves, the probe stays
  bool carries = false;  ///< the other hand's button
  std::optional<TrackerPose> head;
};

/// Where poses of hands come from. Window thread.
class HandSource {
 public:
  HandSource() = default;
  HandSource(const HandSource&) = delete;
  HandSource& operator=(const HandSource&) = delete;
  virtual ~HandSource() = default;

  /// The newest poses at the time `now` [s] of a steady clock. False where there are none any more.
  virtual bool read(double now, TrackedHands& hands) = 0;
};

/// Recorded hands at their own pace, from the first read() on.
class ReplayHands final : public HandSource {
 public:
  explicit ReplayHands(std::vector<TrackedHands> hands) : hands_(std::move(hands)) {}
  bool read(double now, TrackedHands& hands) override;

 private:
  std::vector<TrackedHands> hands_;
  std::size_t next_ = 0;
  double offset_ = 0.0;  ///< from times of the recording to those of the reader
};

/// @throws Error (bad input) naming the file, the line and what was expected: numbers, quaternions of unit
/// length, times that rise.
[[nodiscard]] std::vector<TrackedHands> read_hands(const std::string& file);

/// The heads of a recording of hands; empty where it has none.
[[nodiscard]] std::vector<PoseSample> heads_of(const std::vector<TrackedHands>& hands);

}  // namespace palpate
