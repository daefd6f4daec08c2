/// How fast a hand is, for the velocity gate: over a window, so that neither two packets that came together
/// nor a step of an encoder are a speed.
///
///   v = |x - x_r| / max(t - t_r, kWindow)
///
/// x_r the oldest position within kWindow; where none is, as of a tracker that is slower, the last one. A leap
/// that no hand makes is a speed at once: 15 mm from one sample to the next pass a gate of 1.5 m/s.
///
/// Symbols: x where the hand is in its own frame [m], t when it was there by its sender's clock [s].
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "common/math/vec.h"

namespace palpate {

class HandSpeed {
 public:
  static constexpr double kWindow = 0.010;  ///< [s]

  /// Forgets all positions.
  void reset() noexcept { count_ = 0; }

  /// The speed [m/s] with the position `x` at `time`: zero for the first, and for one before the last; the same
  /// one again at the same time. @pre both finite. @rt Safe.
  [[nodiscard]] double update(double time, const Vec3& x) noexcept {
    if (count_ > 0 && time < last_) reset();  // a clock that was set back
    if (count_ > 0 && !(time > last_)) return speed_;
    speed_ = 0.0;
    if (count_ > 0) {
      std::size_t back = 1;
      while (back < std::min(count_, kKept) && time - kept(back + 1).time <= kWindow) ++back;
      const Sample& from = kept(back);
      speed_ = glm::length((x - from.x) / std::max(time - from.time, kWindow));
    }
    // Positions that lie closer than the window has room for are not kept.
    if (count_ == 0 || time - kept(1).time >= kWindow / (kKept - 1)) samples_[count_++ % kKept] = {time, x};
    last_ = time;
    return speed_;
  }

 private:
  struct Sample {
    double time = 0.0;
    Vec3 x{0.0};
  };
  static constexpr std::size_t kKept = 16;

  [[nodiscard]] const Sample& kept(std::size_t back) const noexcept {
    return samples_[(count_ - back) % kKept];
  }

  std::array<Sample, kKept> samples_{};
  std::size_t count_ = 0;  ///< of all that were kept
  double last_ = 0.0;      ///< [s] time of the last one
  double speed_ = 0.0;     ///< [m/s]
};

}  // namespace palpate
