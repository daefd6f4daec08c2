/// A short vibration that tells the hand of an event: it has left the data, met or passed a surface, come to the end
/// of a line.
///
///   F(t) = F_0 exp(-t / tau) sin(2 pi f t) e,   0 <= t < 5 tau,   tau = 30 ms
///
/// with e the direction of what the hand feels, or upwards where that is nothing (Okamura, Dennerlein and Howe 1998:
/// decaying sinusoids at contact). It pushes as much as it pulls. Before the safety stage, whose caps hold.
#pragma once

#include <cmath>
#include <numbers>

#include "common/haptics/constraint/link_settings.h"
#include "common/math/vec.h"

namespace palpate {

class EventPulse {
 public:
  /// @param time [s] @param force [N]
  void start(double time, const Vec3& force) noexcept {
    const double size = glm::length(force);
    begun_ = time;
    along_ = size > 0.0 ? force / size : Vec3{0.0, 1.0, 0.0};
  }
  void stop() noexcept { begun_ = -HUGE_VAL; }
  [[nodiscard]] Vec3 force(double time, const EventSettings& settings) const noexcept {
    const double t = time - begun_;
    if (!(settings.force > 0.0 && t >= 0.0 && t < kLongest)) return Vec3{0.0};
    const double turns = 2.0 * std::numbers::pi * settings.frequency * t;
    return (settings.force * std::exp(-t / kFade) * std::sin(turns)) * along_;
  }

 private:
  static constexpr double kFade = 0.03, kLongest = 5.0 * kFade;  // [s]

  double begun_ = -HUGE_VAL;  ///< [s]
  Vec3 along_{0.0, 1.0, 0.0};
};

}  // namespace palpate
