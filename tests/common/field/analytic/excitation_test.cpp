// Waves of excitation: against the front that is known in closed form, and the theory of their speeds.
#include "common/field/analytic/excitation.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/excitation_front.h"

namespace palpate {
namespace {

constexpr double kLength = 40.0, kStart = 12.0;

/// A bar along x of one by one cells, each six tetrahedra, its fibres along x or across.
struct Bar {
  std::vector<Vec3> points;
  std::vector<TetMesh::Tet> tets;

  explicit Bar(int cells) {
    const double h = kLength / cells;
    for (int i = 0; i <= cells; ++i)
      for (int n = 0; n < 4; ++n) points.push_back(h * Vec3(i, n & 1, n >> 1));
    const auto at = [](int i, int j, int k) { return static_cast<std::uint32_t>(4 * i + j + 2 * k); };
    constexpr int kRound[7][3] = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 1, 1},
                                  {0, 0, 1}, {1, 0, 1}, {1, 0, 0}};
    for (int i = 0; i < cells; ++i)
      for (int n = 0; n < 6; ++n) {
        const auto& a = kRound[n];
        const auto& b = kRound[n + 1];
        tets.push_back({at(i, 0, 0), at(i + a[0], a[1], a[2]), at(i + b[0], b[1], b[2]), at(i + 1, 1, 1)});
      }
  }

  [[nodiscard]] ExcitationWave wave(const ExcitableTissue& tissue, const Vec3& fibre, double diffusivity,
                                    double step) const {
    std::vector<double> u;
    for (const Vec3& x : points)
      u.push_back(1.0 / (1.0 + std::exp((x.x - kStart) / test::front_width(tissue, diffusivity))));
    return {points, tets, std::vector<Vec3>(tets.size(), fibre), tissue, std::move(u), step};
  }
};

/// Largest distance from (4) after `time`; the bar's ends are too far away to be felt.
double front_error(int cells, double step, double time) {
  ExcitableTissue tissue;
  tissue.recovers = false;
  const Bar bar(cells);
  ExcitationWave wave = bar.wave(tissue, {0.0, 1.0, 0.0}, tissue.d_across, step);
  while (wave.time() < time - 0.5 * step) wave.advance();
  const double width = test::front_width(tissue, tissue.d_across),
               speed = test::front_speed(tissue, tissue.d_across);
  double worst = 0.0;
  for (std::size_t p = 0; p < bar.points.size(); ++p) {
    const double exact = 1.0 / (1.0 + std::exp((bar.points[p].x - kStart - speed * time) / width));
    if (bar.points[p].x > 4.0 && bar.points[p].x < kLength - 4.0)
      worst = std::max(worst, std::abs(wave.potential()[p] - exact));
  }
  return worst;
}

TEST(Excitation, TheKnownFrontIsMetAtSecondOrder) {
  const double coarse = front_error(40, 1.0, 40.0), middle = front_error(80, 0.5, 40.0),
               fine = front_error(160, 0.25, 40.0);
  EXPECT_LT(fine, 5e-3);
  EXPECT_GT(std::log2(coarse / middle), 1.8) << coarse << " " << middle << " " << fine;
  EXPECT_GT(std::log2(middle / fine), 1.8);
}

// On one mesh, so that nothing but the step is left in the differences.
TEST(Excitation, StepsInTimeAreOfSecondOrder) {
  const ExcitableTissue tissue;  // with recovery
  const Bar bar(40);
  std::vector<std::vector<double>> u;
  for (const double step : {1.0, 0.5, 0.25}) {
    ExcitationWave wave = bar.wave(tissue, {0.0, 1.0, 0.0}, tissue.d_across, step);
    while (wave.time() < 40.0 - 0.5 * step) wave.advance();
    u.emplace_back(wave.potential().begin(), wave.potential().end());
  }
  const auto apart = [](const std::vector<double>& a, const std::vector<double>& b) {
    double worst = 0.0;
    for (std::size_t p = 0; p < a.size(); ++p) worst = std::max(worst, std::abs(a[p] - b[p]));
    return worst;
  };
  EXPECT_GT(std::log2(apart(u[0], u[1]) / apart(u[1], u[2])), 1.8);
}

/// Of the front through the bar, by the activation times at two places.
double speed(const Vec3& fibre, double diffusivity) {
  const ExcitableTissue tissue;
  constexpr int kCells = 120;
  const Bar bar(kCells);
  ExcitationWave wave = bar.wave(tissue, fibre, diffusivity, 0.25);
  while (wave.time() < 90.0) wave.advance();
  const auto at = [&](double x) {
    return wave.activation()[static_cast<std::size_t>(4.0 * std::round(x * kCells / kLength))];
  };
  return 10.0 / (at(30.0) - at(20.0));
}

TEST(Excitation, FrontsRunFasterAlongFibresByTheRootOfTheDiffusivities) {
  const ExcitableTissue tissue;
  const double along = speed({-3.0, 0.0, 0.0}, tissue.d_along),
               across = speed({0.0, 1.0, 0.0}, tissue.d_across);
  EXPECT_NEAR(along / across, std::sqrt(tissue.d_along / tissue.d_across), 0.02);
  // Recovery, which lags, slows the front a little.
  EXPECT_NEAR(across, test::front_speed(tissue, tissue.d_across), 0.05 * across);
  EXPECT_NEAR(speed(Vec3{std::nan("")}, tissue.d_across), across, 1e-5) << "without fibres as across them";
}

TEST(Excitation, MuscleComesBackToRestAndRunsTheSameEveryTime) {
  const ExcitableTissue tissue;
  const Bar bar(20);
  std::vector<double> first;
  for (int run = 0; run < 2; ++run) {
    ExcitationWave wave = bar.wave(tissue, {1.0, 0.0, 0.0}, tissue.d_along, 0.5);
    double highest = 0.0;
    while (wave.time() < 600.0) {
      wave.advance();
      for (const double u : wave.potential()) highest = std::max(highest, u);
    }
    EXPECT_LT(highest, 1.1);
    for (const double u : wave.potential()) EXPECT_LT(std::abs(u), 0.05);
    const std::vector<double> u(wave.potential().begin(), wave.potential().end());
    if (run == 0) first = u;
    EXPECT_EQ(u, first);
  }
}

TEST(Excitation, PointsWithoutACellAndFlatCellsAreNoMatter) {
  const ExcitableTissue tissue;
  Bar bar(20);
  const ExcitationWave plain = bar.wave(tissue, {1.0, 0.0, 0.0}, tissue.d_along, 0.5);
  bar.points.emplace_back(99.0, 0.0, 0.0);
  bar.tets.push_back({0, 4, 8, 12});
  ExcitationWave wave = bar.wave(tissue, {1.0, 0.0, 0.0}, tissue.d_along, 0.5);
  for (int i = 0; i < 20; ++i) wave.advance();
  for (const double u : wave.potential()) EXPECT_TRUE(std::isfinite(u));
  EXPECT_TRUE(std::isnan(wave.activation().back()));
}

}  // namespace
}  // namespace palpate
