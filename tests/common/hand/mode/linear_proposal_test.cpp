// Curves of the mode `linear` from data whose noise, boundaries and materials are known.

#include "common/hand/mode/linear_proposal.h"

#include <cmath>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

namespace palpate {
namespace {

constexpr int kN = 48;

/// value(x) with noise of standard deviation `noise` at the points of a lattice of steps 1.
template <typename F>
std::shared_ptr<const ScalarField> field_of(double noise, const F& value) {
  std::mt19937 random{1};
  std::normal_distribution<double> normal{0.0, 1.0};
  std::vector<double> values;
  for (int k = 0; k < kN; ++k)
    for (int j = 0; j < kN; ++j)
      for (int i = 0; i < kN; ++i) values.push_back(value(i) + noise * normal(random));
  DataSet block{.name = "",
                .topology = UniformTopology{.points = Index3(kN)},
                .arrays = {},
                .visible = {},
                .hidden_cells = {}};
  block.arrays.push_back(make_array("s", Association::kPoint, 1, std::span<const double>(values)));
  return make_scalar_field({block}, {.array = "s"}, "test", 1);
}

// Two materials, 0 and 100, with a boundary of 25 a unit over four steps, under noise of 1.
TEST(LinearProposal, BoundariesAreFeltAboveTheNoise) {
  const auto field = field_of(1.0, [](int i) { return 25.0 * std::clamp(i - 22.0, 0.0, 4.0); });
  const ScalarStatistics statistics = scalar_statistics(*field);
  EXPECT_GT(statistics.noise, 1.0);
  EXPECT_LT(statistics.noise, 5.0);
  EXPECT_NEAR(statistics.boundary, 25.0, 3.0);
  EXPECT_NEAR(statistics.boundaries, 4.0 / 47.0, 0.02);
  ASSERT_EQ(statistics.materials.size(), 2U);
  EXPECT_NEAR(statistics.materials[0], 0.0, 5.0);
  EXPECT_NEAR(statistics.materials[1], 100.0, 5.0);
  const LinearSettings settings = proposed({}, statistics);
  EXPECT_TRUE(settings.valid());
  EXPECT_EQ(settings.measure, LinearMeasure::kGradient);
  EXPECT_LT(settings.axes[0].kappa(statistics.noise), 0.3);
  EXPECT_EQ(settings.axes[0].kappa(statistics.boundary), 1.0);
  EXPECT_GT(settings.axes[1].tau(statistics.boundary), settings.axes[1].tau(statistics.noise));
  EXPECT_NE(proposal_text(settings, statistics).find("materials at"), std::string::npos);
}

TEST(LinearProposal, OfNoiseAloneNoBoundaryIsClaimed) {
  const auto field = field_of(1.0, [](int) { return 0.0; });
  const ScalarStatistics statistics = scalar_statistics(*field);
  EXPECT_FALSE(statistics.has_boundaries());
  const LinearSettings settings = proposed({}, statistics);
  EXPECT_EQ(settings.measure, LinearMeasure::kValue);
  EXPECT_TRUE(settings.valid());
}

}  // namespace
}  // namespace palpate
