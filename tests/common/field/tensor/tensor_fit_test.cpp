// Tensors fitted to made signals, the gradients that do not determine one, and masks.

#include "common/field/tensor/tensor_fit.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/tensor/foreground_mask.h"
#include "common/math/symmetric3.h"

namespace palpate::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Directions that spread over the sphere (a spiral), after one volume without weighting.
GradientTable spiral(int directions, double weighting) {
  GradientTable table{{0.0}, {Vec3{0.0}}};
  for (int i = 0; i < directions; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / directions, angle = 2.4 * i;
    const double r = std::sqrt(1.0 - z * z);
    table.weightings.push_back(weighting);
    table.directions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  return table;
}

/// S_0 exp(-b g^T D g) of every volume.
std::vector<double> signals_of(const GradientTable& table, const Mat3& tensor, double unweighted) {
  std::vector<double> signals;
  for (std::size_t i = 0; i < table.weightings.size(); ++i) {
    const Vec3& g = table.directions[i];
    signals.push_back(unweighted * std::exp(-table.weightings[i] * glm::dot(g, tensor * g)));
  }
  return signals;
}

TensorFit fit_of(const std::vector<double>& signals, const GradientTable& table,
                 const FitOptions& options = {}) {
  const DataArray array =
      make_array("signals", Association::kPoint, static_cast<int>(table.weightings.size()),
                 std::span<const double>(signals));
  return fit_tensors(array, table, {}, options);
}

const Mat3 kTensor{Vec3{1.2e-3, 0.4e-3, -0.1e-3}, Vec3{0.4e-3, 0.8e-3, 0.2e-3},
                   Vec3{-0.1e-3, 0.2e-3, 0.5e-3}};

TEST(TensorFit, RecoversTheTensorOfExactSignalsWhateverTheirScale) {
  const GradientTable table = spiral(12, 1000.0);
  for (const FitWeights weights : {FitWeights::kSignal, FitWeights::kOrdinary}) {
    for (const double unweighted : {1.0, 1e-30, 1e30}) {
      const TensorFit fit = fit_of(signals_of(table, kTensor, unweighted), table, {.weights = weights});
      ASSERT_EQ(fit.fitted, 1U);
      const std::array<double, 6> wanted{kTensor[0][0], kTensor[1][0], kTensor[2][0],
                                         kTensor[1][1], kTensor[2][1], kTensor[2][2]};
      for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(static_cast<double>(fit.tensors[c]), wanted[c], 1e-9);
      EXPECT_EQ(fit.negative + fit.lifted + fit.unusable, 0U);
    }
  }
}

TEST(TensorFit, WeighsStrongSignalsMore) {
  const GradientTable table = spiral(30, 1500.0);
  const Mat3 tensor{Vec3{2.0e-3, 0.0, 0.0}, Vec3{0.0, 0.3e-3, 0.0}, Vec3{0.0, 0.0, 0.3e-3}};
  std::vector<double> signals = signals_of(table, tensor, 1000.0);
  for (double& s : signals) s += 30.0;  // a noise floor: it hides the weak signals
  const auto error = [&](FitWeights weights) {
    return std::abs(static_cast<double>(fit_of(signals, table, {.weights = weights}).tensors[0]) - 2.0e-3);
  };
  EXPECT_LT(error(FitWeights::kSignal), error(FitWeights::kOrdinary));
}

TEST(TensorFit, DefinesWhatBadSignalsGive) {
  const GradientTable table = spiral(12, 1000.0);
  const std::vector<double> good = signals_of(table, kTensor, 100.0);
  std::vector<double> all(4 * good.size(), 0.0);  // voxel 0: no signal at all
  const auto voxel = [&](std::size_t v) {
    return all.begin() + static_cast<std::ptrdiff_t>(v * good.size());
  };
  std::copy(good.begin(), good.end(), voxel(1));
  voxel(1)[3] = 0.0;
  std::copy(good.begin(), good.end(), voxel(2));
  voxel(2)[4] = -5.0;
  std::copy(good.begin(), good.end(), voxel(3));
  voxel(3)[5] = kNaN;
  const TensorFit fit = fit_of(all, table);
  EXPECT_EQ(fit.fitted, 2U);
  EXPECT_EQ(fit.lifted, 2U);
  EXPECT_EQ(fit.unusable, 2U);
  for (std::size_t c = 0; c < 6; ++c) {
    EXPECT_TRUE(std::isnan(fit.tensors[c]));
    EXPECT_TRUE(std::isfinite(fit.tensors[6 + c]));
    EXPECT_TRUE(std::isfinite(fit.tensors[12 + c]));
    EXPECT_TRUE(std::isnan(fit.tensors[18 + c]));
  }
}

TEST(TensorFit, KeepsOrZeroesNegativeEigenvalues) {
  const GradientTable table = spiral(12, 1000.0);
  const Mat3 tensor{Vec3{1.5e-3, 0.0, 0.0}, Vec3{0.0, 0.3e-3, 0.0}, Vec3{0.0, 0.0, -0.2e-3}};
  const std::vector<double> signals = signals_of(table, tensor, 100.0);
  const TensorFit kept = fit_of(signals, table);
  EXPECT_EQ(kept.negative, 1U);
  EXPECT_NEAR(static_cast<double>(kept.tensors[5]), -0.2e-3, 1e-9);
  const TensorFit zeroed = fit_of(signals, table, {.negative = NegativeEigenvalues::kZero});
  EXPECT_EQ(zeroed.negative, 1U);
  EXPECT_NEAR(static_cast<double>(zeroed.tensors[5]), 0.0, 1e-9);
  EXPECT_NEAR(static_cast<double>(zeroed.tensors[0]), 1.5e-3, 1e-9);
}

TEST(TensorFit, IsTheSameForAnyNumberOfThreads) {
  const GradientTable table = spiral(12, 1000.0);
  std::vector<double> all;
  for (int v = 0; v < 10'000; ++v) {
    std::vector<double> signals = signals_of(table, kTensor, 100.0 + v);
    signals[static_cast<std::size_t>(v) % signals.size()] *= 1.1;
    all.insert(all.end(), signals.begin(), signals.end());
  }
  EXPECT_EQ(fit_of(all, table, {.threads = 1}).tensors, fit_of(all, table, {.threads = 4}).tensors);
}

TEST(GradientProblem, NamesTablesThatDetermineNoTensor) {
  EXPECT_EQ(gradient_problem(spiral(7, 1000.0)), "");
  EXPECT_NE(gradient_problem(spiral(5, 1000.0)), "");
  EXPECT_NE(gradient_problem(spiral(12, 0.0)), "");
  EXPECT_NE(gradient_problem({{0.0}, {Vec3{0.0}}}), "");
  EXPECT_NE(gradient_problem({}), "");
  // Without an unweighted volume the mean diffusivity of one shell cannot be told from S_0 …
  GradientTable shell = spiral(12, 1000.0);
  shell.weightings.erase(shell.weightings.begin());
  shell.directions.erase(shell.directions.begin());
  EXPECT_NE(gradient_problem(shell), "");
  // … but that of two shells can.
  for (std::size_t i = 0; i < 6; ++i) shell.weightings[2 * i] = 2000.0;
  EXPECT_EQ(gradient_problem(shell), "");
  // All directions in one plane.
  GradientTable flat = spiral(12, 1000.0);
  for (std::size_t i = 1; i < flat.directions.size(); ++i)
    flat.directions[i] = glm::normalize(Vec3{flat.directions[i].x, flat.directions[i].y, 0.0});
  EXPECT_NE(gradient_problem(flat), "");
}

TEST(GradientTable, TakesSmallWeightingsForNone) {
  const GradientTable table{{0.0, 5.0, 1000.0, 1000.0}, {Vec3{0.0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0.0}}};
  EXPECT_TRUE(table.unweighted(0));
  EXPECT_TRUE(table.unweighted(1));
  EXPECT_FALSE(table.unweighted(2));
  EXPECT_TRUE(table.unweighted(3));
  EXPECT_EQ(table.unweighted_count(), 3U);
}

TEST(ForegroundMask, IsTheLargestBrightPartWithItsHolesFilled) {
  const Index3 n{20, 20, 20};
  std::vector<float> values(8000, 1.0F);
  const auto at = [&](int i, int j, int k) -> float& {
    return values[static_cast<std::size_t>(i + 20 * (j + 20 * k))];
  };
  for (int k = 4; k < 15; ++k) {
    for (int j = 4; j < 15; ++j) {
      for (int i = 4; i < 15; ++i) at(i, j, k) = 100.0F;
    }
  }
  at(9, 9, 9) = 0.0F;                              // a hole
  for (int k = 4; k < 9; ++k) at(6, 6, k) = 0.0F;  // one that is open below
  at(1, 1, 1) = at(18, 18, 18) = 1e6F;             // bright specks
  at(10, 10, 10) = std::numeric_limits<float>::quiet_NaN();
  const std::vector<std::uint8_t> mask = foreground_mask(values, n);
  EXPECT_EQ(std::count(mask.begin(), mask.end(), 1), 11 * 11 * 11);
  EXPECT_EQ(mask[static_cast<std::size_t>(9 + 20 * (9 + 20 * 9))], 1);
  EXPECT_EQ(mask[static_cast<std::size_t>(1 + 20 * (1 + 20 * 1))], 0);

  const std::vector<float> flat(8, 3.0F);
  const std::vector<std::uint8_t> all = foreground_mask(flat, Index3{2});
  EXPECT_EQ(std::count(all.begin(), all.end(), 1), 8);
}

}  // namespace
}  // namespace palpate::test
