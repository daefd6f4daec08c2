// Scalars taken at the points of a uniform grid, and what is told of their error.
#include "common/field/scalar_lattice.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/math/power_of_two.h"

namespace palpate::test {
namespace {

const Box kBox{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}};

template <typename Formula, typename Inside>
ScalarSampler sampler(Formula formula, Inside inside) {
  return [=](const Vec3& x, CellHint&) {
    if (!inside(x)) return ScalarSample{};
    return ScalarSample{formula(x), SampleStatus::kOk};
  };
}
template <typename Formula>
ScalarSampler sampler(Formula formula) {
  return sampler(formula, [](const Vec3& x) { return kBox.contains(x); });
}

LatticeError error_of(const ScalarSampler& sample, int points, int threads = 2) {
  const DataSet block = take_scalar(sample, "s", lattice_over(kBox, Index3(points)), threads, nullptr);
  return lattice_error(sample, block, threads, nullptr);
}

TEST(ScalarLattice, IsExactWhereTheScalarIsTrilinear) {
  const LatticeError error =
      error_of(sampler([](const Vec3& x) { return 1.0 + 2.0 * x.x - 3.0 * x.y * x.z + x.x * x.y * x.z; }), 7);
  EXPECT_LT(error.worst, 1e-11);  // points stand 1e-12 nearer to the middle
  EXPECT_EQ(error.compared, 20'000U);
  EXPECT_EQ(error.outside, 0.0);
  EXPECT_EQ(error.hidden, 0.0);
}

// |s_h - s| <= h^2 / 8 (|s_xx| + |s_yy| + |s_zz|), and the mean of u^2 (1 - u)^2 over a cell is 1 / 30: for
// s = x^2 the worst is h^2 / 4, the root mean square h^2 / sqrt(30), of a range of 1.
TEST(ScalarLattice, TellsTheErrorOfAParabolaAsTheoryDoes) {
  const ScalarSampler square = sampler([](const Vec3& x) { return x.x * x.x; });
  for (const int points : {9, 17, 33}) {
    const double h = 2.0 / (points - 1);
    const LatticeError error = error_of(square, points);
    EXPECT_NEAR(error.rms, h * h / std::sqrt(30.0), 0.02 * h * h) << points;
    EXPECT_NEAR(error.worst, h * h / 4.0, 0.001 * h * h) << points;
  }
}

// A ball in its box: its share of the box is pi / 6, and the layer of cells that its border cuts gets thinner
// as the lattice gets finer.
TEST(ScalarLattice, CountsWhatLiesOutsideAndAtTheBorder) {
  const auto in_ball = [](const Vec3& x) { return glm::length(x) <= 1.0; };
  const ScalarSampler ball = sampler([](const Vec3& x) { return x.x; }, in_ball);
  constexpr double kFiveSigma = 0.018;  // of 20 000 places
  const LatticeError coarse = error_of(ball, 33), fine = error_of(ball, 65);
  for (const LatticeError& error : {coarse, fine}) {
    EXPECT_NEAR(error.outside, 1.0 - std::numbers::pi / 6.0, kFiveSigma);
    EXPECT_LT(error.worst, 1e-11) << "what has no value is not compared";
    EXPECT_NEAR(static_cast<double>(error.compared), 20'000.0 * (1.0 - error.outside) * (1.0 - error.hidden),
                0.5);
  }
  EXPECT_GT(fine.hidden, 0.03);
  EXPECT_NEAR(coarse.hidden / fine.hidden, 2.0, 0.35);
  const DataSet block = take_scalar(ball, "s", lattice_over(kBox, Index3(9)), 1, nullptr);
  int checked = 0;
  for (int k = 0; k < 9; ++k) {
    for (int j = 0; j < 9; ++j) {
      for (int i = 0; i < 9; ++i) {
        const double radius = glm::length(0.25 * Vec3(i, j, k) - 1.0);
        const double value = block.arrays.front().at(static_cast<std::size_t>(i + 9 * (j + 9 * k)));
        EXPECT_EQ(std::isfinite(value), radius <= 1.0) << i << ' ' << j << ' ' << k;
        ++checked;
      }
    }
  }
  EXPECT_EQ(checked, 729);
}

TEST(ScalarLattice, KeepsItsBitsUnderPowersOfTwoAndAnyNumberOfThreads) {
  const auto formula = [](const Vec3& x) { return std::sin(3.0 * x.x) * std::cos(2.0 * x.y) + x.z * x.z; };
  const LatticeError one = error_of(sampler(formula), 12, 1), three = error_of(sampler(formula), 12, 3);
  EXPECT_EQ(one.rms, three.rms);
  EXPECT_EQ(one.worst, three.worst);
  for (const int exponent : {-40, 40}) {
    const double length = power_of_two(exponent), value = power_of_two(-2 * exponent);
    const Box box{length * kBox.lower, length * kBox.upper};
    const ScalarSampler scaled = [&](const Vec3& x, CellHint&) {
      if (!box.contains(x)) return ScalarSample{};
      return ScalarSample{value * formula(x / length), SampleStatus::kOk};
    };
    const DataSet block = take_scalar(scaled, "s", lattice_over(box, Index3(12)), 2, nullptr);
    const LatticeError error = lattice_error(scaled, block, 2, nullptr);
    EXPECT_EQ(error.rms, one.rms) << exponent;
    EXPECT_EQ(error.worst, one.worst) << exponent;
  }
}

TEST(ScalarLattice, HasNoNaNForHugeEvenOrMissingValues) {
  const LatticeError huge = error_of(sampler([](const Vec3& x) { return 1e300 * x.x * x.x; }), 9);
  EXPECT_NEAR(huge.worst, 1.0 / 64.0, 1e-4);
  EXPECT_TRUE(std::isfinite(huge.rms));
  const LatticeError even = error_of(sampler([](const Vec3&) { return 5.0; }), 4);
  EXPECT_EQ(even.rms, 0.0);
  EXPECT_EQ(even.worst, 0.0);
  EXPECT_EQ(even.compared, 20'000U);
  const LatticeError nothing =
      error_of(sampler([](const Vec3&) { return 1.0; }, [](const Vec3&) { return false; }), 4);
  EXPECT_EQ(nothing.compared, 0U);
  EXPECT_EQ(nothing.outside, 1.0);
  EXPECT_EQ(nothing.hidden, 0.0);
  EXPECT_EQ(nothing.rms, 0.0);
}

TEST(ScalarLattice, MakesCellsMostLikeCubes) {
  EXPECT_EQ(cubic_points({Vec3(0.0), {4.0, 2.0, 1.0}}, 9), Index3(9, 5, 3));
  EXPECT_EQ(cubic_points({Vec3(0.0), {1.0, 1000.0, 1.0}}, 128), Index3(2, 128, 2));
  EXPECT_EQ(cubic_points({Vec3(0.0), {1e-30, 2e-30, 2e-30}}, 3), Index3(2, 3, 3));
}

TEST(ScalarLattice, StopsWhenCancelled) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW((void)take_scalar(sampler([](const Vec3& x) { return x.x; }), "s",
                                 lattice_over(kBox, Index3(4)), 1, &progress),
               Cancelled);
}

}  // namespace
}  // namespace palpate::test
