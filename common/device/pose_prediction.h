/// Where a tracked head will be when a picture of now is seen: at constant velocity (Ikits 2006, chapter 9
/// names predictive filtering as what is to follow; end-to-end latency is a large part of registration
/// error).
///
/// Symbols. t_0 time of the newest sample, p_0, q_0 its pose; t_i, p_i, q_i those of the samples within the
/// window W before it; tau how far ahead [s].
///
///   p(t_0 + tau) = p_0 + v tau,          v     the slope of the least-squares line through p_i       (1)
///   q(t_0 + tau) = exp(omega tau) q_0,   omega the slope of that through log(q_i q_0^-1)             (2)
///
/// With n samples at equal distances the error of (1) under constant acceleration a, and its variance with
/// noise of variance sigma^2 in each sample, are
///
///   a tau (tau + W) / 2,   sigma^2 (1 + tau W / S + tau^2 / S),   S = W^2 n (n + 1) / (12 (n - 1))   (3)
///
/// where holding the newest pose would be off by v tau + a tau^2 / 2. A longer window is less noisy and less
/// true.
#pragma once

#include <array>
#include <cstddef>

#include "common/kinematics/tracker_correction.h"

namespace palpate {

class PosePrediction {
 public:
  static constexpr double kWindow = 0.05;  ///< [s]
  /// Farther ahead nothing is said: a velocity is none of that time any more [s].
  static constexpr double kFarthest = 0.25;

  /// @param window W [s], > 0.
  explicit PosePrediction(double window = kWindow) noexcept : window_(window) {}

  /// The next sample. One that is not later than the newest one changes nothing.
  /// @pre time and pose are finite, the quaternion is of unit length. @rt Safe.
  void take(double time, const TrackerPose& pose) noexcept;
  /// From then on there are no samples.
  void forget() noexcept { count_ = 0; }
  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
  [[nodiscard]] double newest_time() const noexcept { return at(0).time; }  ///< @pre !empty()

  /// (1) and (2), tau = time - newest_time() held within 0 and kFarthest. @pre !empty(). @rt Safe.
  [[nodiscard]] TrackerPose predicted(double time) const noexcept;
  [[nodiscard]] Vec3 velocity() const noexcept { return velocity_; }  ///< v [m/s]
  [[nodiscard]] Vec3 turning() const noexcept { return turning_; }  ///< omega [rad/s], in the tracker's frame

 private:
  struct Sample {
    double time = 0.0;
    TrackerPose pose;
  };
  static constexpr std::size_t kMost = 64;  ///< of a tracker at 1.2 kHz
  /// The i-th newest.
  [[nodiscard]] const Sample& at(std::size_t i) const noexcept {
    return ring_[(next_ + kMost - 1 - i) % kMost];
  }
  void fit() noexcept;

  double window_;
  std::array<Sample, kMost> ring_{};
  std::size_t next_ = 0, count_ = 0;
  Vec3 velocity_{0.0}, turning_{0.0};
};

}  // namespace palpate
