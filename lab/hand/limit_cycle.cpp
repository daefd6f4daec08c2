#include "lab/hand/limit_cycle.h"

#include <algorithm>
#include <cstddef>

namespace palpate {
namespace {

struct Range {
  double lower, upper;
  [[nodiscard]] double width() const { return upper - lower; }
};

Range range_of(std::span<const double> x) {
  const auto [lowest, highest] = std::minmax_element(x.begin(), x.end());
  return {*lowest, *highest};
}

/// Rises through the middle; one counts only after x was in the lowest quarter of the range, so that noise
/// about the middle is no rise.
double rises_per_second(std::span<const double> x, const Range& range, double period) {
  const double middle = 0.5 * range.lower + 0.5 * range.upper, low = range.lower + 0.25 * range.width();
  double first = 0.0, last = 0.0;  // [periods]
  int rises = 0;
  bool was_low = false;
  for (std::size_t n = 1; n < x.size(); ++n) {
    was_low = was_low || x[n - 1] < low;
    if (!was_low || x[n] < middle) continue;
    was_low = false;
    last = static_cast<double>(n) - (x[n] - middle) / (x[n] - x[n - 1]);
    if (rises++ == 0) first = last;
  }
  return rises > 1 && last > first ? (rises - 1) / ((last - first) * period) : 0.0;
}

}  // namespace

Oscillation find_oscillation(std::span<const double> x, double period, double floor) {
  const std::size_t quarter = x.size() / 4;
  if (quarter < 2) return {};
  const std::span<const double> tail = x.last(quarter);
  const Range before = range_of(x.last(2 * quarter).first(quarter)), range = range_of(tail);
  return {.sustained = range.width() > floor && range.width() > (1.0 - kDecay) * before.width(),
          .amplitude = 0.5 * range.width(),
          .frequency = rises_per_second(tail, range, period)};
}

}  // namespace palpate
