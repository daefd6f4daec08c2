#include "tests/bench/stream_tracer/curve_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace palpate::bench {
namespace {

constexpr double kQuantile = 0.95;

std::vector<double> arcs(const std::vector<Vec3>& points) {
  std::vector<double> arc(points.size(), 0.0);
  for (std::size_t i = 1; i < points.size(); ++i)
    arc[i] = arc[i - 1] + glm::distance(points[i - 1], points[i]);
  return arc;
}

/// Distance of `x` from the parabola through three neighbouring points of a curve: chords alone would sag by
/// more than the errors to be told apart where lines turn sharply.
double distance_to_arc(const Vec3& x, const Vec3& before, const Vec3& at, const Vec3& after) {
  const Vec3 slope = 0.5 * (after - before), bend = after - 2.0 * at + before;
  double t = 0.0;
  for (int i = 0; i < 4; ++i) {
    const Vec3 r = at + t * slope + 0.5 * t * t * bend - x, d = slope + t * bend;
    const double dd = glm::dot(d, d);
    if (!(dd > 0.0)) break;
    t = std::clamp(t - glm::dot(r, d) / dd, -1.0, 1.0);
  }
  return glm::length(at + t * slope + 0.5 * t * t * bend - x);
}

/// Largest distance of the points of `line` (but the last) from `exact`, searched within 2 % of a diagonal
/// of the same arc length, and more where the line is longer.
double line_error(const std::vector<Vec3>& line, const std::vector<Vec3>& exact, double diagonal) {
  if (line.size() < 2 || exact.size() < 3) return HUGE_VAL;
  const std::vector<double> arc = arcs(line), exact_arc = arcs(exact);
  double worst = 0.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double window = 0.02 * diagonal + 0.01 * arc[i];
    auto first = std::lower_bound(exact_arc.begin(), exact_arc.end(), arc[i] - window);
    if (first != exact_arc.begin()) --first;
    auto last = std::upper_bound(exact_arc.begin(), exact_arc.end(), arc[i] + window);
    if (first == exact_arc.end()) return HUGE_VAL;
    const auto begin = static_cast<std::size_t>(first - exact_arc.begin());
    const auto end = static_cast<std::size_t>(last - exact_arc.begin());
    // Every 16th point first, then all around the nearest of them.
    constexpr std::size_t kStride = 16;
    const auto nearest_of = [&](std::size_t from, std::size_t to, std::size_t stride) {
      std::size_t at = from;
      double squared_at = HUGE_VAL;
      for (std::size_t k = from; k < to; k += stride) {
        const Vec3 d = exact[k] - line[i];
        const double squared = glm::dot(d, d);
        if (squared < squared_at) {
          squared_at = squared;
          at = k;
        }
      }
      return at;
    };
    const std::size_t near = nearest_of(begin, end, kStride);
    const std::size_t nearest_at =
        nearest_of(near > kStride ? near - kStride : 0, std::min(near + kStride, exact.size()), 1);
    const std::size_t middle = std::clamp<std::size_t>(nearest_at, 1, exact.size() - 2);
    const double nearest = distance_to_arc(line[i], exact[middle - 1], exact[middle], exact[middle + 1]);
    worst = std::max(worst, nearest);
  }
  // A line that stops before the exact one is wrong too.
  const double missing = exact_arc.back() - arc.back();
  return missing > 0.05 * exact_arc.back() + 0.02 * diagonal ? HUGE_VAL : worst;
}

}  // namespace

double quantile_error(const std::vector<Curve>& lines, const std::vector<Curve>& exact, double diagonal) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    errors.push_back(line_error(lines[i].points, exact[i].points, diagonal) / diagonal);
  }
  if (errors.empty()) return HUGE_VAL;
  const auto at = static_cast<std::ptrdiff_t>(
      std::min(errors.size() - 1, static_cast<std::size_t>(kQuantile * static_cast<double>(errors.size()))));
  std::nth_element(errors.begin(), errors.begin() + at, errors.end());
  return errors[static_cast<std::size_t>(at)];
}

}  // namespace palpate::bench
