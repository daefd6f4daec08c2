/// A number that is set along a way, by a slider or a knob, with detents where it rests.
#pragma once

#include <algorithm>
#include <cmath>

namespace palpate {

struct DialRange {
  double lower = 0.0, upper = 1.0;  ///< lower < upper
  double step = 0.0;                ///< between detents, from lower on; 0: there are none

  /// The value that a hand asks for, within the range; on a detent where there are such. The next detent is
  /// gone to when the hand is beyond the middle by a tenth of a step, so that a trembling one does not
  /// flicker.
  [[nodiscard]] double held(double asked, double current) const noexcept {
    const double within = std::clamp(asked, lower, upper);
    if (!(step > 0.0)) return within;
    constexpr double kBeyond = 0.6;  // steps
    if (std::abs(within - current) <= kBeyond * step) return current;
    return std::clamp(lower + step * std::round((within - lower) / step), lower, upper);
  }
  /// From 0 at the lower end to 1 at the upper one.
  [[nodiscard]] double part(double value) const noexcept { return (value - lower) / (upper - lower); }
  [[nodiscard]] double at_part(double part) const noexcept { return lower + part * (upper - lower); }
};

}  // namespace palpate
