#include "common/scene/time_steps.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {

TimeChoice choose_time(const std::vector<double>& times, std::string_view text) {
  if (text == "first" || text.empty()) return {};
  if (text == "last") return {times.empty() ? 0 : times.size() - 1, true};
  double wanted = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), wanted);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(wanted)) {
    throw usage_error("--time " + std::string(text) + ": first, last or a time is expected");
  }
  if (times.empty()) throw usage_error("--time " + std::string(text) + ": the data has no time steps");

  const auto nearest = std::min_element(times.begin(), times.end(), [wanted](double a, double b) {
    return std::abs(a - wanted) < std::abs(b - wanted);
  });
  const auto [lowest, highest] = std::minmax_element(times.begin(), times.end());
  // Between two steps the nearer one is a fair answer, and so is rounding at the ends; far outside it is a
  // slip.
  const double interval = times.size() > 1 ? (*highest - *lowest) / static_cast<double>(times.size() - 1)
                                           : 1e-6 * std::abs(*lowest);
  if (std::abs(*nearest - wanted) > interval && wanted != *nearest) {
    throw usage_error("--time " + std::string(text) + ": the data has times from " + exact_number(*lowest) +
                      " to " + exact_number(*highest) + " (" + std::to_string(times.size()) + " steps)");
  }
  return {as_size(nearest - times.begin()), *nearest == wanted};
}

std::vector<std::size_t> steps_in_order(const std::vector<double>& times) {
  std::vector<std::size_t> steps(std::max<std::size_t>(1, times.size()));
  std::iota(steps.begin(), steps.end(), std::size_t{0});
  if (!times.empty())
    std::stable_sort(steps.begin(), steps.end(),
                     [&](std::size_t a, std::size_t b) { return times[a] < times[b]; });
  return steps;
}

std::size_t step_beside(const std::vector<double>& times, std::size_t step, bool on) {
  const std::vector<std::size_t> order = steps_in_order(times);
  const auto place = as_size(std::ranges::find(order, step) - order.begin());
  return order[(place + (on ? 1 : order.size() - 1)) % order.size()];
}

std::size_t nearest_step(const std::vector<double>& times, double time) {
  const auto nearest = std::ranges::min_element(times, {}, [&](double t) { return std::abs(t - time); });
  return as_size(nearest - times.begin());
}

}  // namespace palpate
