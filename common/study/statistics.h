/// Statistics of paired measurements: what compares two conditions that the same participants went through.
///
/// Each function works on one number a participant. Values are finite; where a result is not defined (too few
/// values, no spread) it is NaN, and pages say so.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate {

[[nodiscard]] double mean_of(std::span<const double> values) noexcept;
/// With n - 1 in the denominator. NaN for fewer than two.
[[nodiscard]] double deviation_of(std::span<const double> values) noexcept;
/// a_i - b_i. @pre both have the same length.
[[nodiscard]] std::vector<double> differences(std::span<const double> a, std::span<const double> b);

/// Student's t test of paired values, two-sided.
struct PairedTest {
  std::size_t count = 0;            ///< pairs
  double mean = 0.0;                ///< of a - b
  double lower = 0.0, upper = 0.0;  ///< its 95 % confidence interval
  double t = 0.0;
  double freedom = 0.0;  ///< n - 1
  double p = 1.0;
  /// d_z = mean / deviation of the differences: what the test's power depends on.
  double effect_z = 0.0;
  /// d_av = mean / mean of both deviations, times Hedges' correction 1 - 3 / (4 (n - 1) - 1)
  /// (Lakens 2013, Front. Psychol. 4:863, eqs. 4 and 10).
  double effect_average = 0.0;
};
/// @pre both have the same length.
[[nodiscard]] PairedTest paired_test(std::span<const double> a, std::span<const double> b);

/// Inferential confidence intervals of two means (Tryon 2001, Psychol. Methods 6:371): they do not overlap
/// exactly where the paired t test finds a difference at 1 - level.
///
///   h_i = E t_(1 - (1 - level) / 2, n - 1) s_i / sqrt(n),   E = SE(a - b) / (SE_a + SE_b)
struct InferentialIntervals {
  double reduction = 1.0;  ///< E
  double half_a = 0.0, half_b = 0.0;
};
[[nodiscard]] InferentialIntervals inferential_intervals(std::span<const double> a, std::span<const double> b,
                                                         double level = 0.95);

struct Correlation {
  std::size_t count = 0;
  double r = 0.0;                    ///< Pearson's
  double p = 1.0;                    ///< two-sided, by t = r sqrt((n - 2) / (1 - r^2))
  double lower = -1.0, upper = 1.0;  ///< 95 %, by Fisher's z
};
[[nodiscard]] Correlation correlation(std::span<const double> x, std::span<const double> y);

/// Shapiro and Wilk's test of normality by Royston's algorithm AS R94 (1995, Appl. Statist. 44:547), for 3 to
/// 5000 values.
struct NormalityTest {
  double w = 0.0;
  double p = 1.0;
};
[[nodiscard]] NormalityTest shapiro_wilk(std::span<const double> values);

/// Wilcoxon's signed-rank test of paired values, two-sided. Pairs that are equal are left out. Exact up to 50
/// pairs without ties, else by the normal distribution with the correction for ties (Hollander, Wolfe and
/// Chicken 2014, sec. 3.1).
struct SignedRankTest {
  std::size_t count = 0;   ///< pairs that differ
  double statistic = 0.0;  ///< the smaller sum of ranks
  double p = 1.0;
  double effect = 0.0;  ///< matched-pairs rank-biserial correlation (Kerby 2014)
  bool exact = true;
};
[[nodiscard]] SignedRankTest signed_rank_test(std::span<const double> a, std::span<const double> b);

/// A trial for permutation_test().
struct TrialValue {
  int participant = 0;  ///< from 0, without gaps
  int stimulus = 0;     ///< likewise
  bool treated = false;
  double value = 0.0;
};
/// What a mixed model with crossed random effects of participants and stimuli asks (Baayen, Davidson and Bates
/// 2008), without its assumptions:
///
///   y = m + participant_i + stimulus_j + beta c + e,   c = 1 where treated, else 0
///
/// beta by least squares; the distribution of its partial correlation by changing, for all trials of a participant at
/// once, which are treated: what differs between participants in the effect stays in the reference distribution. Not of
/// beta itself: changes unbalance a balanced design, and beta varies more then. All 2^n changes up to 14 participants, else
/// `draws` of them at random; p counts the observed one among them.
struct PermutationTest {
  double effect = 0.0;  ///< beta
  double p = 1.0;
  std::size_t draws = 0;
  bool exact = false;
};
[[nodiscard]] PermutationTest permutation_test(std::span<const TrialValue> trials, std::uint64_t seed,
                                               std::size_t draws = 9'999);

/// Power of the paired t test, two-sided, for an effect d_z and n participants.
[[nodiscard]] double paired_power(double effect_z, std::size_t participants, double significance = 0.05);
/// The fewest participants with at least that power; 0 where `most` do not give it.
[[nodiscard]] std::size_t participants_for(double effect_z, double power, double significance = 0.05,
                                           std::size_t most = 100'000);

}  // namespace palpate
