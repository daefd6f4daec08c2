/// Times of steps as files write them.
#pragma once

#include <string>
#include <vector>

namespace palpate {

/// `times` in their order, those that are equal up to the rounding of sums (1e-12 of them, or 1e-15 of the
/// largest) made the same number: of 0.3 and 0.30000000000000004 the one that is written shorter.
[[nodiscard]] std::vector<double> joined_times(std::vector<double> times);

/// @throws Error (bad input) with `file` where they do not rise from step to step, or are not finite.
void check_rising(const std::string& file, const std::vector<double>& times);

}  // namespace palpate
