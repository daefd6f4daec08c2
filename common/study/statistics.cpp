#include "common/study/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/study/distributions.h"

namespace palpate {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// sum (x_i - mean x) (y_i - mean y)
double product_sum(std::span<const double> x, std::span<const double> y) noexcept {
  const double mean_x = mean_of(x), mean_y = mean_of(y);
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - mean_x) * (y[i] - mean_y);
  return sum;
}

}  // namespace

double mean_of(std::span<const double> values) noexcept {
  if (values.empty()) return kNone;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double deviation_of(std::span<const double> values) noexcept {
  if (values.size() < 2) return kNone;
  return std::sqrt(product_sum(values, values) / static_cast<double>(values.size() - 1));
}

std::vector<double> differences(std::span<const double> a, std::span<const double> b) {
  PALPATE_CHECK(a.size() == b.size());
  std::vector<double> out(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) out[i] = a[i] - b[i];
  return out;
}

PairedTest paired_test(std::span<const double> a, std::span<const double> b) {
  const std::vector<double> d = differences(a, b);
  PairedTest test{.count = d.size(), .mean = mean_of(d)};
  test.freedom = static_cast<double>(d.size()) - 1.0;
  const double deviation = deviation_of(d);
  if (!(deviation > 0.0)) {
    test.lower = test.upper = test.t = test.p = test.effect_z = test.effect_average = kNone;
    return test;
  }
  const double error = deviation / std::sqrt(static_cast<double>(d.size()));
  test.t = test.mean / error;
  test.p = t_above(test.t, test.freedom);
  const double half = t_quantile(0.975, test.freedom) * error;
  test.lower = test.mean - half;
  test.upper = test.mean + half;
  test.effect_z = test.mean / deviation;
  const double hedges = 1.0 - 3.0 / (4.0 * test.freedom - 1.0);
  test.effect_average = hedges * test.mean / (0.5 * (deviation_of(a) + deviation_of(b)));
  return test;
}

InferentialIntervals inferential_intervals(std::span<const double> a, std::span<const double> b,
                                           double level) {
  const std::vector<double> d = differences(a, b);
  if (d.size() < 2) return {kNone, kNone, kNone};
  const double root = std::sqrt(static_cast<double>(d.size()));
  const double error_a = deviation_of(a) / root, error_b = deviation_of(b) / root;
  const double t = t_quantile(0.5 + 0.5 * level, static_cast<double>(d.size() - 1));
  InferentialIntervals out;
  out.reduction = error_a + error_b > 0.0 ? deviation_of(d) / root / (error_a + error_b) : kNone;
  out.half_a = out.reduction * t * error_a;
  out.half_b = out.reduction * t * error_b;
  return out;
}

Correlation correlation(std::span<const double> x, std::span<const double> y) {
  PALPATE_CHECK(x.size() == y.size());
  Correlation out{.count = x.size()};
  const double spread = std::sqrt(product_sum(x, x) * product_sum(y, y));
  if (x.size() < 3 || !(spread > 0.0)) return {x.size(), kNone, kNone, kNone, kNone};
  const auto n = static_cast<double>(x.size());
  out.r = std::clamp(product_sum(x, y) / spread, -1.0, 1.0);
  out.p = t_above(out.r * std::sqrt((n - 2.0) / std::max(0.0, 1.0 - out.r * out.r)), n - 2.0);
  if (x.size() > 3) {
    const double half = normal_quantile(0.975) / std::sqrt(n - 3.0);
    out.lower = std::tanh(std::atanh(out.r) - half);
    out.upper = std::tanh(std::atanh(out.r) + half);
  }
  return out;
}

double paired_power(double effect_z, std::size_t participants, double significance) {
  if (participants < 2 || !std::isfinite(effect_z)) return kNone;
  const auto n = static_cast<double>(participants);
  const double critical = t_quantile(1.0 - 0.5 * significance, n - 1.0);
  const double shift = std::abs(effect_z) * std::sqrt(n);
  // Beyond that the series of the noncentral distribution are sums of zeros: the power is 1 to all digits.
  if (shift > critical + 30.0) return 1.0;
  return noncentral_t_above(critical, n - 1.0, shift) + (1.0 - noncentral_t_above(-critical, n - 1.0, shift));
}

std::size_t participants_for(double effect_z, double power, double significance, std::size_t most) {
  if (!std::isfinite(effect_z) || effect_z == 0.0) return 0;
  const auto enough = [&](std::size_t n) { return paired_power(effect_z, n, significance) >= power; };
  std::size_t low = 1, high = 2;
  while (high < most && !enough(high)) {
    low = high;
    high = std::min(2 * high, most);
  }
  if (!enough(high)) return 0;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (enough(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace palpate
