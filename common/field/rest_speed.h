/// What is slower than this is at rest, as the cells of a solid block are.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace palpate {

/// 2^-36 of the speed that one point in a hundred exceeds, so that a single wrong value does not make all the
/// others slow. Of `points` points a few hundred, evenly spread, are asked by `speed_at(index)`; those that are
/// not finite do not count.
template <typename SpeedAt>
[[nodiscard]] double rest_speed(std::size_t points, const SpeedAt& speed_at) {
  constexpr std::size_t kMostSamples = 500;
  constexpr double kOfFast = 0x1p-36;
  const std::size_t stride = (points + kMostSamples - 1) / kMostSamples;
  std::vector<double> speeds;
  for (std::size_t p = 0; p < points; p += stride) {
    const double speed = speed_at(p);
    if (std::isfinite(speed)) speeds.push_back(speed);
  }
  if (speeds.empty()) return 0.0;
  const auto rank = speeds.begin() + static_cast<std::ptrdiff_t>(99 * (speeds.size() - 1) / 100);
  std::ranges::nth_element(speeds, rank);
  return kOfFast * *rank;
}

}  // namespace palpate
