/// The eyes of a tracked head before a screen, from poses as they come to what a picture needs.
///
///   reported pose -> without the tracker's distortion -> where it will be when the picture is seen
///   -> both eyes on it
///
/// A head that is not seen, or not since kStale, stays where it was, then comes to the resting eye; one that
/// is seen again is come to from there, so that the view never jumps (devices: head-tracked stereo).
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "common/device/pose_prediction.h"
#include "common/device/pose_source.h"
#include "common/kinematics/workbench_file.h"

namespace palpate {

/// Left, right [m] in the tracker's frame.
using Eyes = std::array<Vec3, 2>;

class HeadTracker {
 public:
  enum class State : std::uint8_t {
    kResting,  ///< no head was seen yet, or not for long: the resting eye
    kTracked,
    kFrozen,  ///< not seen: where it was
    kGliding  ///< on the way to the resting eye
  };
  /// A sample that is older says nothing of the head any more [s].
  static constexpr double kStale = 0.1;
  /// The way back to a head that is seen again takes so long [s].
  static constexpr double kReturn = 0.3;

  /// @param screen that the resting eye is before, [m] in the tracker's frame.
  /// @param separation of the eyes where the workbench does not say where they are on the head [m].
  HeadTracker(const WorkbenchGeometry& workbench, const Screen& screen, double separation);

  /// What the source has now. @param now [s] of the clock of its samples.
  void follow(PoseSource& source, double now);
  /// The eyes of the time `seen` >= now, when the picture is. Samples tell of a time before their own, by the
  /// sensor's latency.
  [[nodiscard]] Eyes eyes(double now, double seen);

  [[nodiscard]] State state() const noexcept { return state_; }
  /// "tracked", "frozen", …
  [[nodiscard]] const char* state_name() const noexcept;
  /// Whether the last follow() found the head.
  [[nodiscard]] bool present() const noexcept { return present_; }
  /// When the newest sample was taken, by its own word [s]. @pre present().
  [[nodiscard]] double sampled_at() const noexcept { return prediction_.newest_time(); }
  [[nodiscard]] const Eyes& resting() const noexcept { return resting_; }
  /// On a head of this pose.
  [[nodiscard]] Eyes eyes_on(const TrackerPose& pose) const noexcept;

 private:
  void go(State state, double now) noexcept;

  std::optional<TrackerCorrection> correction_;
  Eyes on_head_{};  ///< in the head sensor's frame
  Eyes resting_{};
  double sensor_latency_, freeze_, glide_;
  bool predict_;
  PosePrediction prediction_;
  PoseSample newest_;     ///< seen or not
  bool present_ = false;  ///< the last follow() found the head
  bool seen_ = false;     ///< some follow() did

  State state_ = State::kResting;
  double since_ = 0.0;  ///< when it began [s]
  double back_ = 0.0;   ///< how long the way to the tracked head takes; 0: it is there
  Eyes from_{};         ///< where the eyes were when it began
  Eyes shown_{};
};

/// How late pictures are: the median of the last ones, so that one that hung counts for nothing.
class LatencyMeter {
 public:
  /// A duration [s].
  void add(double seconds) noexcept;
  /// [s]; 0 before the first one.
  [[nodiscard]] double median() const noexcept;

 private:
  static constexpr std::size_t kCount = 31;
  std::array<double, kCount> ring_{};
  std::size_t next_ = 0, count_ = 0;
};

}  // namespace palpate
