/// The velocity of a hand from positions with noise or steps: first-order adaptive windowing (Janabi-Sharifi,
/// Hayward & Chen 2000, "Discrete-time adaptive windowing for velocity estimation", end-fit form).
///
///   v_k = (x_k - x_(k-n)) / (t_k - t_(k-n))
///
/// with the longest window n for which each position in it lies within the noise d of that straight line:
///
///   |x_(k-i) - (x_k - v_k (t_k - t_(k-i)))| <= d,   0 < i < n,   n < kWindow
///
/// A slow hand is averaged over a long window, which a step of an encoder hardly shows in; a quick turn of it
/// shortens the window at once. A plain difference of an encoder of 27 um at 1 kHz jumps by 27 mm/s a count.
/// Here the distance from the line is Euclidean, all three axes have one window, and times need not be even.
/// The velocity of a jump too far for a number is zero.
#pragma once

#include <array>
#include <cstddef>

#include "common/math/vec.h"

namespace palpate {

class VelocityEstimate {
 public:
  static constexpr std::size_t kWindow = 16;  ///< positions that are kept

  /// @param noise d [m]: half the peak-to-peak noise of a position, or the step of an encoder. @pre finite,
  /// >= 0.
  explicit VelocityEstimate(double noise) noexcept : noise_(noise) {}

  /// Forgets all positions.
  void reset() noexcept;
  /// Takes a position, and gives the velocity there [m/s]: zero for the first one. A time [s] that is not
  /// later than the one before changes nothing. @pre both finite. @rt Safe: at most kWindow^2 / 2 distances.
  const Vec3& update(double time, const Vec3& position) noexcept;
  [[nodiscard]] const Vec3& velocity() const noexcept { return velocity_; }
  /// How many intervals the window of velocity() had.
  [[nodiscard]] std::size_t window() const noexcept { return window_; }

 private:
  struct Sample {
    double time = 0.0;
    Vec3 position{0.0};
  };
  /// The sample `back` before the newest.
  [[nodiscard]] const Sample& sample(std::size_t back) const noexcept {
    return samples_[(newest_ + kWindow - back) % kWindow];
  }
  [[nodiscard]] bool fits(const Vec3& velocity, std::size_t window) const noexcept;

  double noise_;
  std::array<Sample, kWindow> samples_{};
  std::size_t newest_ = 0;
  std::size_t count_ = 0;
  Vec3 velocity_{0.0};
  std::size_t window_ = 0;
};

}  // namespace palpate
