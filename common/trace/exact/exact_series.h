/// The series (4) of exact_cell.h: how many terms it takes, and their weights at the nodes of the arc length.
#pragma once

#include <cstdint>

#include "common/math/pack4.h"

namespace palpate {

inline constexpr double kMaxRate = 2.0;  ///< largest |h C| that the series is made for

/// Nodes of the five-point Lobatto rule on [0, 1] after the first: c, 1/2, 1 - c, 1 with
/// c = (1 - sqrt(3/7)) / 2.
inline constexpr double kArcNodes[4] = {0.17267316464601142810, 0.5, 0.82732683535398857190, 1.0};

namespace series {

inline constexpr int kFirst = 2;  // the series begins with s_2
inline constexpr int kMaxPairs = 15;
inline constexpr int kUsualPairs =
    6;  // never fewer: a loop of unpredictable length costs more than its terms

/// What the terms after s_last add to w, at most, relative to its largest rate: |s_k| <= k (k - 1) / 2
/// |C|^(k - 2), |q| <= 3 |C|^2 and |r| <= |C|^3.
consteval double left_out(double theta, int last) {
  double sum = 0.0;
  for (int k = last + 1; k <= last + 24; ++k) {
    double term = 0.5 * k * (k - 1) * theta * theta;
    for (int i = 1; i <= k; ++i) term *= (i <= k - 2 ? theta : 1.0) / i;
    sum += term * (1.0 + 4.0 * theta / (k + 1) + theta * theta / ((k + 1) * (k + 2)));
  }
  return sum;
}

// The number of terms by theta = |h C|, in quarters of its powers of two from 2^-16 on: the top bits of the
// number are the index.
inline constexpr int kMantissaBits = 2;
inline constexpr int kLowestExponent = -16;
inline constexpr int kIndexShift = 52 - kMantissaBits;
inline constexpr std::int64_t kLowestIndex = (1023 + kLowestExponent) << kMantissaBits;
inline constexpr int kIndexCount = ((1 - kLowestExponent) << kMantissaBits) + 1;

struct PairCounts {
  std::uint8_t count[kIndexCount];
};

consteval PairCounts make_pair_counts() {
  PairCounts table{};
  int pairs = 1;
  for (int i = 0; i < kIndexCount; ++i) {
    // The upper end of the interval.
    double theta = i + 1 == kIndexCount ? kMaxRate : 1.25 + 0.25 * (i & 3);
    for (int e = (i >> kMantissaBits) + kLowestExponent; e < 0; ++e) theta *= 0.5;
    while (left_out(theta, kFirst + 2 * pairs - 1) > 0x1p-53) ++pairs;
    table.count[i] = static_cast<std::uint8_t>(pairs);
  }
  return table;
}
inline constexpr PairCounts kPairCounts = make_pair_counts();
static_assert(kPairCounts.count[kIndexCount - 1] <= kMaxPairs);

struct Weights {
  alignas(32) double row[kFirst + 2 * kMaxPairs + 2][4];  ///< kArcNodes^k / k!
};

consteval Weights make_weights() {
  Weights weights{};
  for (int m = 0; m < 4; ++m) {
    double value = 1.0;
    for (int k = 0; k < kFirst + 2 * kMaxPairs + 2; ++k) {
      weights.row[k][m] = value;
      value *= kArcNodes[m] / (k + 1);
    }
  }
  return weights;
}
inline constexpr Weights kWeights = make_weights();

}  // namespace series

inline namespace PALPATE_PACK {

/// How many pairs of terms leave less than 2^-53 of w out. @pre 0 <= theta <= kMaxRate (1 + 2^-20).
[[nodiscard]] inline int pair_count(double theta) noexcept {
  const std::int64_t index =
      (__builtin_bit_cast(std::int64_t, theta) >> series::kIndexShift) - series::kLowestIndex;
  return series::kPairCounts
      .count[index < 0 ? 0 : (index < series::kIndexCount ? index : series::kIndexCount - 1)];
}

/// S_0, S_1 and S_2 of (4) at kArcNodes, with p, q, r of h C.
struct SeriesSums {
  Pack4 s0, s1, s2;
};

/// Sums (4) by (5) taken two steps at once, which halves the chain of dependent operations:
/// s_(k+2) = (p^2 + q) s_k + (p q + r) s_(k-1) + p r s_(k-2).
[[nodiscard]] inline SeriesSums sum_series(double p, double q, double r, int pairs) noexcept {
  const double two = p * p + q, three = p * q + r, four = p * r;
  double even = 1.0, odd = p, even_before = 0.0, odd_before = 0.0;
  SeriesSums sum;
  const double(*row)[4] = &series::kWeights.row[series::kFirst];
  Pack4 w0 = Pack4::load(row[0]), w1 = Pack4::load(row[1]);
  const auto add_pair = [&] {
    const Pack4 w2 = Pack4::load(row[2]), w3 = Pack4::load(row[3]);
    sum.s0 += even * w0 + odd * w1;
    sum.s1 += even * w1 + odd * w2;
    sum.s2 += even * w2 + odd * w3;
    const double new_even = two * even + (three * odd_before + four * even_before);
    const double new_odd = two * odd + (three * even + four * odd_before);
    even_before = even;
    odd_before = odd;
    even = new_even;
    odd = new_odd;
    w0 = w2;
    w1 = w3;
    row += 2;
  };
#pragma GCC unroll 6
  for (int i = 0; i < series::kUsualPairs; ++i) add_pair();
  for (int i = series::kUsualPairs; i < pairs; ++i) add_pair();
  return sum;
}

}  // namespace PALPATE_PACK
}  // namespace palpate
