/// Lines that `trace` wrote, and how far from them a place is: by brute force, since it judges cleverer ways.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "common/math/vec.h"

namespace palpate::test {

/// A traced line, from its upstream to its downstream end: points close to each other.
using Curve = std::vector<Vec3>;

/// Index of the point nearest to `x`.
inline std::size_t nearest_to(const Curve& curve, const Vec3& x) {
  std::size_t nearest = 0;
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const Vec3 away = curve[i] - x;
    const double squared = glm::dot(away, away);
    if (!(squared < least)) continue;
    least = squared;
    nearest = i;
  }
  return nearest;
}

/// Distance of `x` from the curve: the nearest point, then the parabola through it and its neighbours.
inline double distance_to(const Curve& curve, const Vec3& x) {
  const std::size_t nearest = nearest_to(curve, x);
  double distance = glm::distance(curve[nearest], x);
  if (curve.size() < 3) return distance;
  const std::size_t middle = std::clamp<std::size_t>(nearest, 1, curve.size() - 2);
  const Vec3 &before = curve[middle - 1], &at = curve[middle], &after = curve[middle + 1];
  const Vec3 slope = 0.5 * (after - before), bend = after - 2.0 * at + before;
  double u = static_cast<double>(nearest) - static_cast<double>(middle);
  for (int step = 0; step < 8; ++step) {
    const Vec3 away = at + u * slope + (0.5 * u * u) * bend - x, along = slope + u * bend;
    const double steep = glm::dot(along, along);
    if (!(steep > 0.0)) break;
    u = std::clamp(u - glm::dot(away, along) / steep, -1.0, 1.0);
    distance = std::min(distance, glm::length(at + u * slope + (0.5 * u * u) * bend - x));
  }
  return distance;
}

}  // namespace palpate::test
