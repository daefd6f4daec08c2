/// Whether p values are those of no effect.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace palpate::test {

/// Kolmogorov and Smirnov's test of whether values in [0, 1] are uniform, by the asymptotic distribution with
/// Stephens' correction (1970).
struct UniformityTest {
  double distance = 0.0;  ///< D
  double p = 1.0;
};

[[nodiscard]] inline UniformityTest uniformity_test(std::span<const double> values) {
  if (values.empty()) return {std::nan(""), std::nan("")};
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const auto n = static_cast<double>(sorted.size());
  UniformityTest out;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const auto before = static_cast<double>(i);
    out.distance = std::max({out.distance, (before + 1.0) / n - sorted[i], sorted[i] - before / n});
  }
  const double root = std::sqrt(n);
  const double x = (root + 0.12 + 0.11 / root) * out.distance;
  double p = 0.0;
  for (int k = 1; k <= 100; ++k) p += (k % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * x * x);
  out.p = x < 0.2 ? 1.0 : std::clamp(p, 0.0, 1.0);
  return out;
}

}  // namespace palpate::test
