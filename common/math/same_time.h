/// Times of data that are one, written in two ways.
#pragma once

#include <algorithm>
#include <cmath>

namespace palpate {

/// Whether `a` and `b` differ by rounding alone: a time is often a sum of steps, 0.30000000000000004 for 0.3.
[[nodiscard]] inline bool same_time(double a, double b) noexcept {
  constexpr double kRounding = 1e-14;
  return a == b || std::abs(a - b) <= kRounding * std::max(std::abs(a), std::abs(b));
}

}  // namespace palpate
