// Tensors fitted to made signals, the gradients that do not determine one, and masks.

#include "common/field/tensor/tensor_fit.h"

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/tensor/fit_kernel.h"
#include "common/field/tensor/foreground_mask.h"
#include "common/math/counter_random.h"
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

// Voxels of many kinds, some without a solution: what a lane yields must depend neither on the kernel nor on
// the other lanes.
TEST(FitKernel, GivesTheSameBitsOnEveryProcessorAndInEveryLane) {
  const GradientTable table = spiral(9, 1000.0);
  const std::size_t volumes = table.weightings.size();
  std::vector<std::array<double, kFitUnknowns>> rows(volumes);
  for (std::size_t i = 0; i < volumes; ++i) {
    const double b = table.weightings[i] / 1000.0;
    const Vec3& g = table.directions[i];
    rows[i] = {-b * g.x * g.x,
               -b * 2.0 * g.x * g.y,
               -b * 2.0 * g.x * g.z,
               -b * g.y * g.y,
               -b * 2.0 * g.y * g.z,
               -b * g.z * g.z,
               1.0};
  }
  using Lanes = FitFour::Lanes;
  constexpr std::size_t kVoxels = 40;
  std::vector<std::array<std::vector<double>, 2>> voxels(kVoxels);  // logs, weights
  for (std::size_t v = 0; v < kVoxels; ++v) {
    for (std::size_t i = 0; i < volumes; ++i) {
      voxels[v][0].push_back(-3.0 * uniform_at(100 * v + i));
      // Every fifth has weights that leave most unknowns open.
      voxels[v][1].push_back(v % 5 == 4 && i > 2 ? 0.0 : std::exp(2.0 * voxels[v][0].back()));
    }
  }
  const auto solved = [&](const FitKernel& kernel, const std::array<std::size_t, 4>& four) {
    std::vector<Lanes> logs(volumes), weights(volumes);
    for (std::size_t lane = 0; lane < 4; ++lane) {
      for (std::size_t i = 0; i < volumes; ++i) {
        logs[i][lane] = voxels[four[lane]][0][i];
        weights[i][lane] = voxels[four[lane]][1][i];
      }
    }
    FitFour work{.rows = rows, .logs = logs, .weights = weights, .reweighted = 2};
    const unsigned good = kernel.fit(work);
    return std::pair{good, work.solution};
  };
  const FitKernel& baseline = fit_kernels().front();
  for (std::size_t v = 0; v < kVoxels; ++v) {
    const auto [good, alone] = solved(baseline, {v, v, v, v});
    EXPECT_EQ(good, v % 5 == 4 ? 0U : 15U) << v;
    for (const FitKernel& kernel : fit_kernels()) {
      const std::size_t lane = v % 4;
      std::array<std::size_t, 4> four{(v + 1) % kVoxels, (v + 4) % kVoxels, (v + 9) % kVoxels, 0};
      four[lane] = v;
      const auto [some, together] = solved(kernel, four);
      EXPECT_EQ((some >> lane) & 1U, good & 1U) << kernel.name;
      if (good == 0) continue;
      for (std::size_t r = 0; r < kFitUnknowns; ++r) EXPECT_EQ(together[r][lane], alone[r][0]) << kernel.name;
    }
  }
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

TEST(TensorFit, NineteenOfTwentyDirectionsLieInTheirCone) {
  // Noise on the logarithms, alike for all, of which an unweighted fit is the right one.
  const GradientTable table = spiral(14, 1000.0);
  const Mat3 tensor{Vec3{1.7e-3, 0.0, 0.0}, Vec3{0.0, 0.5e-3, 0.0}, Vec3{0.0, 0.0, 0.3e-3}};
  const std::vector<double> exact = signals_of(table, tensor, 100.0);
  const FitOptions options{.weights = FitWeights::kOrdinary, .details = true};
  const TensorFit sure = fit_of(exact, table, options);
  EXPECT_LT(sure.cones[0], 1e-3F);
  EXPECT_NEAR(sure.baselines[0], 100.0, 1e-3);
  constexpr std::size_t kVoxels = 4000;
  std::mt19937_64 random{7};
  std::normal_distribution<double> noise(0.0, 0.05);
  std::vector<double> signals;
  for (std::size_t v = 0; v < kVoxels; ++v) {
    for (const double signal : exact) signals.push_back(signal * std::exp(noise(random)));
  }
  const TensorFit fit = fit_of(signals, table, options);
  std::size_t inside = 0;
  for (std::size_t v = 0; v < kVoxels; ++v) {
    const float* const d = fit.tensors.data() + 6 * v;
    const SymmetricEigen eigen =
        symmetric_eigen({Vec3{d[0], d[1], d[2]}, Vec3{d[1], d[3], d[4]}, Vec3{d[2], d[4], d[5]}});
    const double off = std::acos(std::min(1.0, std::abs(eigen.vectors[0].x))) * 180.0 / std::acos(-1.0);
    inside += off <= static_cast<double>(fit.cones[v]) ? 1 : 0;
  }
  // The cone is as wide all round as its long axis: it holds a little more than 95 %.
  EXPECT_GT(inside, kVoxels * 94 / 100);
  EXPECT_LT(inside, kVoxels * 99 / 100);
}

TEST(TensorFit, SevenVolumesSayNothingOfTheirNoise) {
  const GradientTable table = spiral(6, 1000.0);
  const TensorFit fit = fit_of(signals_of(table, kTensor, 1.0), table, {.details = true});
  EXPECT_TRUE(std::isnan(fit.cones[0]));
  EXPECT_TRUE(fit_of(signals_of(table, kTensor, 1.0), table).cones.empty());
}

}  // namespace
}  // namespace palpate::test
