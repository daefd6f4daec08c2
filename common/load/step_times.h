/// Times of steps as files write them.
#pragma once

#include <vector>

namespace palpate {

/// `times` in their order, those that are equal up to the rounding of sums (1e-12 of them, or 1e-15 of the
/// largest) made the same number: of 0.3 and 0.30000000000000004 the one that is written shorter.
[[nodiscard]] std::vector<double> joined_times(std::vector<double> times);

}  // namespace palpate
