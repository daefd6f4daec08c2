/// What an error along the flow costs in distance from the curve.
///
/// Such an error shifts the point on its curve, by a time tau that a steady flow keeps. That is no distance, as long as the
/// flow is nearly the same over the shift: of the flow's own change over it, |J t| tau, this share of the shift is distance.
/// From 1 on, the flow over the shift is another one: the curve may never come as far. So it is behind a saddle, where the
/// point was turned by its error alone and the curve ends.
#pragma once

#include <algorithm>
#include <cmath>

namespace palpate {

class TimeShift {
 public:
  /// Farther than that is beyond any domain.
  static constexpr double kFar = 0x1p300;

  void start() noexcept { shift_ = lost_ = 0.0; }

  /// The shift is now `tau`. @param rate |J t|, t the unit tangent: how fast the velocity changes along the line [1/time].
  void set(double tau, double rate) noexcept {
    if (!(tau > 0.0 && tau < kFar)) return;  // at rest
    shift_ = tau;
    // What has been lost stays so, wherever the flow goes on from here.
    lost_ = std::max(lost_, std::min(1.0, rate * tau) * tau);
  }

  /// The shift grows by `tau`.
  void add(double tau, double rate) noexcept { set(shift_ + tau, rate); }

  /// Distance from the curve, where the line has this speed.
  [[nodiscard]] double distance(double speed) const noexcept { return std::min(lost_ * speed, kFar); }

 private:
  double shift_ = 0.0, lost_ = 0.0;
};

}  // namespace palpate
