#include "common/trace/line_time.h"

#include <cmath>

#include "common/ode/root.h"

namespace palpate {
namespace {

/// Time as a cubic of u = part of the piece.
struct TimeCubic {
  double start = 0.0, rise = 0.0, first = 0.0, last = 0.0;

  explicit TimeCubic(const LineNode& a, const LineNode& b) noexcept : start(a.time), rise(b.time - a.time) {
    const double length = b.arc - a.arc;
    const double slope_a = length / a.speed, slope_b = length / b.speed;
    // Both slopes within three times the mean one is enough for monotonicity.
    constexpr double kMonotone = 3.0;
    if (slope_a <= kMonotone * rise && slope_b <= kMonotone * rise) {
      first = slope_a - rise;
      last = rise - slope_b;
    }
  }
  [[nodiscard]] double at(double u) const noexcept {
    return start + u * rise + (u * (1.0 - u)) * ((1.0 - u) * first + u * last);
  }
};

}  // namespace

double time_at(const GrowingLine& line, int piece, double arc) noexcept {
  const LineNode &a = line.node(piece), &b = line.node(piece + 1);
  return TimeCubic(a, b).at((arc - a.arc) / (b.arc - a.arc));
}

TimePlace find_time(const GrowingLine& line, int piece, double time, int max_pieces) noexcept {
  const int first = line.first(), last = line.last();
  TimePlace place{.piece = piece};
  for (; place.pieces < max_pieces; ++place.pieces) {
    const LineNode &a = line.node(place.piece), &b = line.node(place.piece + 1);
    if (time < a.time) {
      if (--place.piece < first) return place;
    } else if (time > b.time) {
      if (++place.piece >= last) return place;
    } else {
      const TimeCubic cubic(a, b);
      constexpr double kTolerance = 0x1p-46;
      const double u = !(time > a.time) ? 0.0
                       : !(time < b.time)
                           ? 1.0
                           : bracketed_root([&](double at) { return cubic.at(at) - time; }, 0.0, 1.0,
                                            a.time - time, b.time - time, kTolerance);
      place.found = true;
      place.arc = a.arc + u * (b.arc - a.arc);
      return place;
    }
  }
  return place;
}

}  // namespace palpate
