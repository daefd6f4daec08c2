// Figures are those of R 4.2.2 and SciPy 1.10.1 for the same values, computed apart from this code.
#include "common/study/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/index.h"
#include "common/study/design.h"
#include "common/study/distributions.h"
#include "common/study/random_stream.h"
#include "tests/support/uniformity.h"

namespace palpate::test {
namespace {

constexpr double kDigits = 1e-9;

// Additional hours of sleep by two drugs: Cushny and Peebles 1905, as Student 1908 has them (R's `sleep`).
constexpr std::array kFirst{0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0};
constexpr std::array kSecond{1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};

TEST(PairedTest, OfStudentsSleepIsThatOfR) {
  const PairedTest test = paired_test(kFirst, kSecond);
  EXPECT_NEAR(test.t, -4.0621276833820366, kDigits);  // R: t.test(paired = TRUE)
  EXPECT_NEAR(test.p, 0.0028328901973842702, kDigits);
  EXPECT_EQ(test.freedom, 9.0);
  EXPECT_NEAR(test.mean, -1.58, kDigits);
  EXPECT_NEAR(test.lower, -2.459885763254729, kDigits);  // SciPy: ttest_rel().confidence_interval()
  EXPECT_NEAR(test.upper, -0.7001142367452712, kDigits);
  EXPECT_NEAR(test.effect_z, -1.2845575625910546, kDigits);  // NumPy, by the formulas of Lakens 2013
  EXPECT_NEAR(test.effect_average, -0.7620537977716155, kDigits);
}

TEST(PairedTest, GivesTheReferencesSmallestPrintedT) {
  EXPECT_NEAR(t_above(12.25, 19.0), 1.827532365786132e-10, 1e-19);  // SciPy: 2 t.sf(12.25, 19)
}

TEST(PairedTest, OfNoSpreadIsNotDefined) {
  const std::array a{1.0, 2.0, 3.0}, b{2.0, 3.0, 4.0};
  EXPECT_TRUE(std::isnan(paired_test(a, b).p));
  EXPECT_TRUE(std::isnan(paired_test(std::array{1.0}, std::array{2.0}).p));
}

TEST(InferentialIntervals, OfStudentsSleepFollowTryon) {
  const InferentialIntervals i = inferential_intervals(kFirst, kSecond);
  EXPECT_NEAR(i.reduction, 0.32442934656485, kDigits);  // NumPy, by the formulas of Tryon 2001
  EXPECT_NEAR(i.half_a, 0.415198323296308, kDigits);
  EXPECT_NEAR(i.half_b, 0.46468743995842093, kDigits);
}

/// They touch where the t test gives p = 0.05: t = t_0.975 makes the difference of the means half_a + half_b.
TEST(InferentialIntervals, TouchWhereTheTestIsAtItsLevel) {
  std::vector<double> a(kFirst.begin(), kFirst.end());
  const PairedTest test = paired_test(a, kSecond);
  const double wanted = test.mean / test.t * t_quantile(0.975, 9.0);
  for (double& x : a) x += -test.mean + wanted;
  const InferentialIntervals i = inferential_intervals(a, kSecond);
  EXPECT_NEAR(paired_test(a, kSecond).p, 0.05, kDigits);
  EXPECT_NEAR(i.half_a + i.half_b, std::abs(wanted), kDigits);
}

TEST(Correlation, OfAnscombesFirstSetIsThatOfSciPy) {
  const std::array x{10.0, 8.0, 13.0, 9.0, 11.0, 14.0, 6.0, 4.0, 12.0, 7.0, 5.0};
  const std::array y{8.04, 6.95, 7.58, 8.81, 8.33, 9.96, 7.24, 4.26, 10.84, 4.82, 5.68};
  const Correlation c = correlation(x, y);  // SciPy: pearsonr()
  EXPECT_NEAR(c.r, 0.81642051634484, kDigits);
  EXPECT_NEAR(c.p, 0.002169628873078783, kDigits);
  EXPECT_NEAR(c.lower, 0.4243912133932165, kDigits);
  EXPECT_NEAR(c.upper, 0.9506932537865606, kDigits);
  EXPECT_EQ(correlation(x, x).p, 0.0);
}

TEST(ShapiroWilk, IsThatOfR) {
  std::vector<double> wave;
  for (int k = 1; k <= 30; ++k) wave.push_back(std::sin(static_cast<double>(k) * k) * k);
  struct Case {
    std::vector<double> values;
    double w, p;
  };
  const std::vector<Case> cases{
      {differences(kFirst, kSecond), 0.82987133192879481, 0.033341608630308141},
      // Weights of men: Shapiro and Wilk 1965.
      {{148, 154, 158, 160, 161, 162, 166, 170, 182, 195, 236}, 0.78881469483538735, 0.0067038140565029254},
      {wave, 0.98198100757939377, 0.87542496596009656},
      {{1, 2, 4, 9}, 0.89468627083933483, 0.40514721117388991},
      {{1, 2, 4}, 0.96428571428571419, 0.6368868450289632}};
  for (const Case& c : cases) {
    const NormalityTest test = shapiro_wilk(c.values);
    EXPECT_NEAR(test.w, c.w, kDigits) << c.values.size();
    EXPECT_NEAR(test.p, c.p, kDigits) << c.values.size();
  }
  EXPECT_TRUE(std::isnan(shapiro_wilk(std::array{1.0, 1.0, 1.0}).p));
}

TEST(SignedRankTest, IsThatOfRExactAndWithTies) {
  // Depression scale factors: Hollander and Wolfe 1973, R's example of wilcox.test().
  const std::array before{1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30};
  const std::array after{0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29};
  const SignedRankTest exact = signed_rank_test(before, after);
  EXPECT_TRUE(exact.exact);
  EXPECT_EQ(exact.statistic, 5.0);
  EXPECT_NEAR(exact.p, 0.0390625, kDigits);
  EXPECT_NEAR(exact.effect, (40.0 - 5.0) / 45.0, kDigits);
  const SignedRankTest ties = signed_rank_test(kFirst, kSecond);
  EXPECT_FALSE(ties.exact);
  EXPECT_EQ(ties.count, 9U);
  EXPECT_NEAR(ties.p, 0.0076324416482055155, kDigits);
}

TEST(UniformityTest, MeasuresTheDistanceOfSciPy) {
  std::vector<double> values;
  for (int k = 1; k <= 40; ++k) values.push_back(std::fmod(k * 0.61803398874989485, 1.0));
  EXPECT_NEAR(uniformity_test(values).distance, 0.036456180001681604, kDigits);  // kstest(x, 'uniform')
  EXPECT_GT(uniformity_test(values).p, 0.99);
  for (double& x : values) x = x * x * x;
  EXPECT_LT(uniformity_test(values).p, 1e-3);
}

/// y = 10 + 3 i - 2 j + (0.7 + 0.2 i) c + sin(7 i + 3 j): beta, and in how many of the 32 changes c explains as much of
/// what dummy variables of i and j leave, by least squares in NumPy.
TEST(PermutationTest, IsThatOfLeastSquaresUnderAllChanges) {
  std::vector<TrialValue> trials;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 4; ++j) {
      const bool c = (i + j) % 2 == 1;
      trials.push_back(
          {i, j, c, 10.0 + 3.0 * i - 2.0 * j + (c ? 0.7 + 0.2 * i : 0.0) + std::sin(7.0 * i + 3.0 * j)});
    }
  }
  const PermutationTest test = permutation_test(trials, 1);
  EXPECT_TRUE(test.exact);
  EXPECT_NEAR(test.effect, 1.40562488834375, kDigits);
  EXPECT_NEAR(test.p, 2.0 / 32.0, kDigits);
}

TEST(PermutationTest, AtRandomFindsWhatIsThereAndNothingElse) {
  const auto p_of = [](double effect) {
    RandomStream random({7});
    std::vector<TrialValue> trials;
    for (int i = 0; i < 18; ++i) {
      for (int j = 0; j < 6; ++j) {
        const bool c = (i + j) % 2 == 1;
        trials.push_back({i, j, c, i + 2.0 * j + (c ? effect : 0.0) + random.normal()});
      }
    }
    return permutation_test(trials, 3, 999).p;
  };
  EXPECT_EQ(p_of(2.0), 0.001) << "the observed one among 1000";
  EXPECT_GT(p_of(0.0), 0.05);
}

/// In the designs of experiments, where paths differ much more than trials do: a path is seen as often in one condition as
/// in the other. That leaves the difference of means alone and makes its deviation large, so that the t test of an effect
/// that there is not is too careful; the permutation test takes the paths out.
TEST(PermutationTest, IsUniformInTheDesignWhereThePathsDiffer) {
  constexpr int kPeople = 8, kPaths = 4;
  constexpr std::uint64_t kSeeds = 400;
  std::vector<double> permuted, paired;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    RandomStream random({seed, 77});
    std::array<double, kPaths> path{};
    for (double& one : path) one = 3.0 * random.normal();
    std::vector<TrialValue> trials;
    std::array<std::array<double, kPeople>, 2> sums{};
    for (const PlannedTrial& t : make_design(
             {.participants = kPeople, .tasks = 1, .practice = 0, .recorded = kPaths, .seed = seed})) {
      const double value = path[as_size(t.stimulus)] + random.normal();
      trials.push_back({t.participant, t.stimulus, t.guided, value});
      sums[t.guided ? 1 : 0][as_size(t.participant)] += value;
    }
    permuted.push_back(permutation_test(trials, seed).p);
    paired.push_back(paired_test(sums[0], sums[1]).p);
  }
  const UniformityTest test = uniformity_test(permuted);
  EXPECT_GT(test.p, 0.01) << "D = " << test.distance;
  EXPECT_LT(uniformity_test(paired).p, 1e-6);
  EXPECT_LT(std::ranges::count_if(paired, [](double p) { return p < 0.05; }), 10) << "never too bold";
}

TEST(Power, OfThePairedTestIsThatOfR) {
  EXPECT_NEAR(paired_power(0.5, 34), 0.80777750127944004,
              kDigits);  // power.t.test(type = "paired", strict = TRUE)
  EXPECT_NEAR(paired_power(0.8, 15), 0.82131053872458426, kDigits);
  EXPECT_NEAR(paired_power(0.3, 20), 0.24708908996810877, kDigits);  // SciPy: nct
  EXPECT_EQ(participants_for(0.5, 0.8), 34U);
  EXPECT_EQ(participants_for(0.8, 0.9), 19U);
  EXPECT_EQ(participants_for(0.2, 0.8), 199U);
  EXPECT_EQ(participants_for(2.0, 0.95), 6U);
  EXPECT_EQ(participants_for(0.0, 0.8), 0U);
  EXPECT_EQ(participants_for(-0.5, 0.8), 34U);
}

}  // namespace
}  // namespace palpate::test
