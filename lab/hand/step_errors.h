/// What many steps of a hand came to: quantiles of an error or a time, and what timing them costs.
#pragma once

#include <vector>

namespace palpate {

struct StepErrors {
  double median = 0.0;
  double p99 = 0.0;
  double max = 0.0;
};

/// Zeros where there are no values.
[[nodiscard]] StepErrors errors_of(std::vector<double> values);

/// What reading the thread's clock twice costs [us].
[[nodiscard]] double clock_microseconds();

}  // namespace palpate
