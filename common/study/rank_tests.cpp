// Tests of statistics.h that order values or permute them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/math/counter_random.h"
#include "common/study/distributions.h"
#include "common/study/statistics.h"

namespace palpate {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

template <std::size_t N>
double polynomial(const std::array<double, N>& c, double x) noexcept {
  double sum = 0.0;
  for (std::size_t i = N; i-- > 0;) sum = sum * x + c[i];
  return sum;
}

/// Number of subsets of {1, ..., n} with the sum `most` at most, over all 2^n: P(W <= most).
double rank_sums_below(std::size_t n, double most) {
  const std::size_t total = n * (n + 1) / 2;
  std::vector<double> ways(total + 1, 0.0);
  ways[0] = 1.0;
  for (std::size_t rank = 1; rank <= n; ++rank) {
    for (std::size_t sum = total; sum >= rank; --sum) ways[sum] += ways[sum - rank];
  }
  double below = 0.0;
  for (std::size_t sum = 0; sum <= total && static_cast<double>(sum) <= most; ++sum) below += ways[sum];
  return below * std::ldexp(1.0, -static_cast<int>(n));
}

}  // namespace

NormalityTest shapiro_wilk(std::span<const double> values) {
  std::vector<double> x(values.begin(), values.end());
  std::ranges::sort(x);
  const std::size_t n = x.size();
  if (n < 3 || n > 5000 || !(x.back() > x.front())) return {kNotKnown, kNotKnown};
  const auto count = static_cast<double>(n);
  // Weights from the expected order statistics m, those at the ends by polynomials.
  std::vector<double> m(n), a(n);
  double square = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    m[i] = normal_quantile((static_cast<double>(i + 1) - 0.375) / (count + 0.25));
    square += m[i] * m[i];
  }
  const double u = 1.0 / std::sqrt(count);
  if (n == 3) {
    a[2] = std::sqrt(0.5);
  } else {
    constexpr std::array<double, 6> kLast{0.0, 0.221157, -0.147981, -2.07119, 4.434685, -2.706056};
    constexpr std::array<double, 6> kNext{0.0, 0.042981, -0.293762, -1.752461, 5.682633, -3.582633};
    const double root = std::sqrt(square);
    a[n - 1] = polynomial(kLast, u) + m[n - 1] / root;
    std::size_t first = 1;
    double left = square - 2.0 * m[n - 1] * m[n - 1], share = 1.0 - 2.0 * a[n - 1] * a[n - 1];
    if (n > 5) {
      a[n - 2] = polynomial(kNext, u) + m[n - 2] / root;
      left -= 2.0 * m[n - 2] * m[n - 2];
      share -= 2.0 * a[n - 2] * a[n - 2];
      first = 2;
    }
    for (std::size_t i = first; i < n - first; ++i) a[i] = m[i] / std::sqrt(left / share);
    if (n > 5) a[1] = -a[n - 2];
  }
  a[0] = -a[n - 1];
  const double mean = mean_of(x);
  double above = 0.0, below = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    above += a[i] * x[i];
    below += (x[i] - mean) * (x[i] - mean);
  }
  NormalityTest out;
  out.w = std::min(1.0, above * above / below);
  if (n == 3) {
    constexpr double kSixOverPi = 1.90985931710274, kLeast = 1.04719755119660;
    out.p = std::clamp(kSixOverPi * (std::asin(std::sqrt(out.w)) - kLeast), 0.0, 1.0);
    return out;
  }
  double y = std::log(1.0 - out.w), center = 0.0, spread = 1.0;
  const double log_count = std::log(count);
  if (n <= 11) {
    const double gamma = polynomial(std::array{-2.273, 0.459}, count);
    if (y >= gamma) return {out.w, 1e-99};
    y = -std::log(gamma - y);
    center = polynomial(std::array{0.544, -0.39978, 0.025054, -6.714e-4}, count);
    spread = std::exp(polynomial(std::array{1.3822, -0.77857, 0.062767, -0.0020322}, count));
  } else {
    center = polynomial(std::array{-1.5861, -0.31082, -0.083751, 0.0038915}, log_count);
    spread = std::exp(polynomial(std::array{-0.4803, -0.082676, 0.0030302}, log_count));
  }
  out.p = normal_below((center - y) / spread);
  return out;
}

SignedRankTest signed_rank_test(std::span<const double> a, std::span<const double> b) {
  std::vector<double> d = differences(a, b);
  std::erase(d, 0.0);
  SignedRankTest out{.count = d.size()};
  if (d.empty()) return {0, kNotKnown, kNotKnown, kNotKnown, false};
  std::ranges::sort(d, {}, [](double x) { return std::abs(x); });
  double plus = 0.0, ties = 0.0;
  for (std::size_t first = 0; first < d.size();) {
    std::size_t end = first;
    while (end < d.size() && std::abs(d[end]) == std::abs(d[first])) ++end;
    const auto same = static_cast<double>(end - first);
    const double rank = 0.5 * static_cast<double>(first + 1 + end);
    if (end - first > 1) ties += same * same * same - same;
    for (; first < end; ++first) plus += d[first] > 0.0 ? rank : 0.0;
  }
  const auto n = static_cast<double>(d.size());
  const double all = 0.5 * n * (n + 1.0);
  out.statistic = std::min(plus, all - plus);
  out.effect = (2.0 * plus - all) / all;
  constexpr std::size_t kMostExact = 50;
  out.exact = d.size() <= kMostExact && ties == 0.0;
  if (out.exact) {
    out.p = std::min(1.0, 2.0 * rank_sums_below(d.size(), out.statistic));
  } else {
    const double variance = n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - ties / 48.0;
    out.p = std::min(1.0, 2.0 * normal_below((out.statistic - 0.5 * all) / std::sqrt(variance)));
  }
  return out;
}

PermutationTest permutation_test(std::span<const TrialValue> trials, std::uint64_t seed, std::size_t draws) {
  PermutationTest out;
  int participants = 0, stimuli = 0;
  for (const TrialValue& trial : trials) {
    participants = std::max(participants, trial.participant + 1);
    stimuli = std::max(stimuli, trial.stimulus + 1);
  }
  const std::size_t n = trials.size();
  if (participants < 2) return {kNotKnown, kNotKnown, 0, false};
  // What participants and stimuli do not explain, by alternating projections: exact in one round where the
  // design is complete. beta is the same with the residuals of y as with y.
  const auto residual = [&](std::vector<double>& v) {
    std::vector<double> sums(as_size(std::max(participants, stimuli)));
    std::vector<double> counts(sums.size());
    const auto sweep = [&](int TrialValue::*group) {
      std::ranges::fill(sums, 0.0);
      std::ranges::fill(counts, 0.0);
      for (std::size_t i = 0; i < n; ++i) {
        sums[as_size(trials[i].*group)] += v[i];
        counts[as_size(trials[i].*group)] += 1.0;
      }
      double largest = 0.0;
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t g = as_size(trials[i].*group);
        v[i] -= sums[g] / counts[g];
        largest = std::max(largest, std::abs(sums[g] / counts[g]));
      }
      return largest;
    };
    constexpr int kMostRounds = 50;
    for (int round = 0; round < kMostRounds; ++round) {
      const double moved = std::max(sweep(&TrialValue::participant), sweep(&TrialValue::stimulus));
      if (round > 0 && moved < 1e-10) break;
    }
  };
  std::vector<double> y(n), c(n);
  for (std::size_t i = 0; i < n; ++i) y[i] = trials[i].value;
  residual(y);
  std::vector<char> changed(as_size(participants), 0);
  struct Fit {
    double beta = kNotKnown;
    double strength = 0.0;  ///< |partial correlation| but for a factor that all changes share
  };
  const auto fit = [&]() -> Fit {
    for (std::size_t i = 0; i < n; ++i) {
      c[i] = trials[i].treated != (changed[as_size(trials[i].participant)] != 0) ? 1.0 : 0.0;
    }
    residual(c);
    double above = 0.0, below = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      above += c[i] * y[i];
      below += c[i] * c[i];
    }
    // Where participants and stimuli tell who is treated, nothing is left for the treatment to explain.
    if (!(below > 1e-12)) return {};
    return {above / below, std::abs(above) / std::sqrt(below)};
  };
  const Fit observed = fit();
  out.effect = observed.beta;
  if (!std::isfinite(out.effect)) return {kNotKnown, kNotKnown, 0, false};
  constexpr int kMostExact = 14;
  out.exact = participants <= kMostExact;
  out.draws = out.exact ? std::size_t{1} << static_cast<unsigned>(participants) : draws;
  // Signs of effects that are equal but for rounding count as equal.
  const double least = observed.strength * (1.0 - 1e-9);
  std::size_t as_far = 0;
  for (std::size_t draw = 0; draw < out.draws; ++draw) {
    for (int i = 0; i < participants; ++i) {
      const bool change =
          out.exact
              ? ((draw >> static_cast<unsigned>(i)) & 1U) != 0
              : uniform_at(seed * 0x9e3779b97f4a7c15U + draw * as_size(participants) + as_size(i)) < 0.5;
      changed[as_size(i)] = change ? 1 : 0;
    }
    if (fit().strength >= least) ++as_far;
  }
  // Of all changes the one without any is the observed one; of random ones it is one more.
  out.p = out.exact ? static_cast<double>(as_far) / static_cast<double>(out.draws)
                    : static_cast<double>(as_far + 1) / static_cast<double>(out.draws + 1);
  return out;
}

}  // namespace palpate
