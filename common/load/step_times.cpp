#include "common/load/step_times.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {

std::vector<double> joined_times(std::vector<double> times) {
  constexpr double kOfTime = 1e-12;
  constexpr double kOfLargest = 1e-15;
  std::vector<std::size_t> order(times.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&times](std::size_t a, std::size_t b) { return times[a] < times[b]; });
  double largest = 0.0;
  for (const double time : times) largest = std::max(largest, std::abs(time));
  for (std::size_t first = 0; first < order.size();) {
    const double time = times[order[first]];
    const double near = std::max(kOfTime * std::abs(time), kOfLargest * largest);
    double shortest = time;
    std::size_t end = first;
    for (; end < order.size() && times[order[end]] - time <= near; ++end) {
      const double other = times[order[end]];
      if (exact_number(other).size() < exact_number(shortest).size()) shortest = other;
    }
    for (; first < end; ++first) times[order[first]] = shortest;
  }
  return times;
}

void check_rising(const std::string& file, const std::vector<double>& times) {
  for (std::size_t t = 0; t < times.size(); ++t) {
    if (std::isfinite(times[t]) && (t == 0 || times[t] > times[t - 1])) continue;
    throw input_error(
        {file, "time step " + std::to_string(t + 1), "has a time that does not rise", "rising times"});
  }
}

}  // namespace palpate
