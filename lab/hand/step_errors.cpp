#include "lab/hand/step_errors.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "lab/hand/probe_run.h"

namespace palpate {

StepErrors errors_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double q) {
    return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
  };
  return {at(0.5), at(0.99), values.back()};
}

double clock_microseconds() {
  constexpr int kReadings = 10'000;
  std::vector<double> costs;
  costs.reserve(kReadings);
  for (int n = 0; n < kReadings; ++n) {
    const double before = thread_microseconds();
    costs.push_back(thread_microseconds() - before);
  }
  return errors_of(std::move(costs)).median;
}

}  // namespace palpate
