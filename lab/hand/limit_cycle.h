/// Whether a motion has come to rest, and how it swings if it has not.
#pragma once

#include <span>

namespace palpate {

struct Oscillation {
  bool sustained = false;  ///< it does not die out
  double amplitude = 0.0;  ///< half of the way from lowest to highest, over the last quarter; unit of x
  double frequency = 0.0;  ///< [Hz] of rises through the middle of that way; 0 where there are fewer than two
};

/// Looks at the last half of evenly spaced samples. An oscillation is sustained where the range of the last
/// quarter is larger than `floor`, and has not fallen by kDecay from that of the quarter before: one that
/// grows, and one that has settled to a limit cycle, but not one that dies out by more than that.
inline constexpr double kDecay = 0.05;
/// @param period [s] between samples.  @param floor unit of x; below it nothing is called a swing.
[[nodiscard]] Oscillation find_oscillation(std::span<const double> x, double period, double floor);

}  // namespace palpate
