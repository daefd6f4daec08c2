// Fibres by rule on the analytic ventricle, against the rule evaluated from closed-form gradients there.
#include "common/field/heart/fibre_rule.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/ventricle.h"
#include "common/field/heart/fibre_angles.h"
#include "tests/support/two_ventricles.h"

namespace palpate {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
const RuleAngles kAngles{.endo = 60.0 * kDegree,
                         .epi = -60.0 * kDegree,
                         .sheet_endo = -65.0 * kDegree,
                         .sheet_epi = 25.0 * kDegree};

struct Ruled {
  Ventricle shape;
  std::shared_ptr<const FieldGrid> grid;
  RuleFibres made;
};

/// @param tagged whether the mesh says where its surfaces are.
Ruled ruled(const VentricleCells& cells, FibreRule rule, const RuleAngles& angles, bool tagged = true) {
  Ruled out;
  DataSet mesh = ventricle_mesh(out.shape, cells);
  std::erase_if(mesh.arrays, [&](const DataArray& array) { return !tagged || array.name != kSurfaceArray; });
  out.grid = make_field_grid(std::span(&mesh, 1), "ventricle", 1);
  const WallSurfaces surfaces = find_wall_surfaces(*out.grid, mesh, "ventricle");
  out.made = make_rule_fibres(*out.grid, surfaces, rule, angles, "ventricle", 1);
  return out;
}

/// The potential between the surfaces as a part of its rise: phi_epi. Its gradient is along lambda, that of the
/// potential from apex to base, a function of mu alone, along mu.
double depth_at(const Ventricle& shape, const Prolate& at) {
  const double inner = shape.potential(shape.lambda_inner), outer = shape.potential(shape.lambda_outer);
  return (shape.potential(at.lambda) - inner) / (outer - inner);
}

/// Of two directions without sign [degrees].
double apart(const Vec3& a, const Vec3& b) {
  return std::acos(std::min(1.0, std::abs(glm::dot(a, b)) / glm::length(a) / glm::length(b))) / kDegree;
}

struct Errors {
  double worst = 0.0, p95 = 0.0, sheet_worst = 0.0;
  std::size_t cells = 0, near_apex = 0;
};

/// @param rule the helix angle at a depth [rad].
Errors errors_of(const Ruled& ruled, const RuleAngles& angles, double least_mu,
                 const std::function<double(double)>& rule) {
  Errors out;
  std::vector<double> all;
  const TetMesh& mesh = *ruled.grid->tets;
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    const Vec3 x = ruled.grid->frame.data_from_local(mesh.position(static_cast<CellIndex>(c), Vec4{0.25}));
    const Prolate at = ruled.shape.coordinates(x);
    if (at.mu < least_mu) {
      ++out.near_apex;
      continue;
    }
    const Mat3 axes = ruled.shape.wall_axes(at);
    const double d = depth_at(ruled.shape, at), alpha = rule(d),
                 beta = angles.sheet_endo * (1.0 - d) + angles.sheet_epi * d;
    const Vec3 across = -std::sin(alpha) * axes[0] + std::cos(alpha) * axes[1];
    const double off = apart(ruled.made.fibres[c], std::cos(alpha) * axes[0] + std::sin(alpha) * axes[1]);
    out.sheet_worst = std::max(
        out.sheet_worst, apart(ruled.made.sheets[c], std::sin(beta) * across + std::cos(beta) * axes[2]));
    all.push_back(off);
    EXPECT_NEAR(glm::length(ruled.made.fibres[c]), 1.0, 1e-9);
    EXPECT_NEAR(glm::dot(ruled.made.fibres[c], ruled.made.sheets[c]), 0.0, 1e-6);
  }
  std::sort(all.begin(), all.end());
  out.cells = all.size();
  out.worst = all.back();
  out.p95 = all[all.size() * 95 / 100];
  return out;
}

double linear(const RuleAngles& angles, double d) { return angles.endo * (1.0 - d) + angles.epi * d; }

TEST(FibreRule, IsTheRuleOfBayerOnTheVentricleWithinOneDegree) {
  const Ruled fine = ruled({.wall = 10, .along = 48, .around = 120}, FibreRule::kBayer, kAngles, false);
  const auto rule = [](double d) { return linear(kAngles, d); };
  const Errors errors = errors_of(fine, kAngles, 0.2, rule);
  RecordProperty("worst_degrees", std::to_string(errors.worst));
  EXPECT_LT(errors.worst, 1.0);
  EXPECT_LT(errors.p95, 0.35);
  EXPECT_LT(errors.sheet_worst, 1.5);
  EXPECT_EQ(fine.made.without, 0U);
  // About the apex, where all that runs along the wall meets, a cell is as wide as the way round.
  EXPECT_LT(errors_of(fine, kAngles, 0.0, rule).worst, 60.0);
  EXPECT_LT(errors_of(fine, kAngles, 0.1, rule).worst, 3.0);
}

/// A cell has one fibre: what the rule turns by between the layers of the mesh is stated.
TEST(FibreRule, StatesHowFarItTurnsWithinACell) {
  for (const int wall : {1, 2, 5, 10}) {
    const Ruled made = ruled({.wall = wall, .along = 24, .around = 48}, FibreRule::kBayer, kAngles);
    const Ventricle& shape = made.shape;
    double least = HUGE_VAL, most = 0.0;
    for (int layer = 0; layer < wall; ++layer) {
      const auto depth = [&](int at) {
        const double part = static_cast<double>(at) / wall;
        return depth_at(shape,
                        {.lambda = shape.lambda_inner + part * (shape.lambda_outer - shape.lambda_inner)});
      };
      const double turn = 120.0 * kDegree * (depth(layer + 1) - depth(layer));
      least = std::min(least, turn);
      most = std::max(most, turn);
    }
    EXPECT_GT(made.made.median_turn, 0.9 * least) << wall;
    EXPECT_LT(made.made.median_turn, 1.1 * most) << wall;
    EXPECT_GE(made.made.most_turn, made.made.median_turn) << wall;
    EXPECT_LT(made.made.most_turn, 1.2 * most) << wall;
  }
}

TEST(FibreRule, ConvergesWithTheMesh) {
  std::vector<double> worst;
  for (const int n : {1, 2, 3}) {
    const Ruled made = ruled({.wall = 3 * n, .along = 14 * n, .around = 36 * n}, FibreRule::kBayer, kAngles);
    worst.push_back(errors_of(made, kAngles, 0.3, [](double d) { return linear(kAngles, d); }).p95);
  }
  EXPECT_LT(worst[1], 0.6 * worst[0]);
  EXPECT_LT(worst[2], 0.8 * worst[1]);
}

// Other angles than the symmetric ones, and none: circumferential everywhere.
TEST(FibreRule, TakesAnyAngles) {
  for (const RuleAngles& angles :
       {RuleAngles{}, RuleAngles{.endo = 80.0 * kDegree, .epi = -50.0 * kDegree},
        RuleAngles{.endo = -30.0 * kDegree, .epi = 90.0 * kDegree, .sheet_endo = 20.0 * kDegree}}) {
    const Ruled made = ruled({.wall = 6, .along = 28, .around = 72}, FibreRule::kBayer, angles);
    const Errors errors = errors_of(made, angles, 0.3, [&](double d) { return linear(angles, d); });
    EXPECT_LT(errors.worst, 2.0) << angles.endo;
    EXPECT_LT(errors.p95, 1.0) << angles.endo;
  }
}

// In the free walls of both ventricles fibres turn from endo to epi, seen from their own cavity; in the septum from
// endo on the left to endo on the right, which is -endo from the left.
TEST(FibreRule, TurnsFromCavityToCavityInTheSeptum) {
  const test::TwoVentricles heart(130.0 * kDegree);
  const auto grid = make_field_grid(std::span(&heart.mesh, 1), "heart", 1);
  const WallSurfaces surfaces = find_wall_surfaces(*grid, heart.mesh, "heart");
  const RuleFibres made = make_rule_fibres(*grid, surfaces, FibreRule::kBayer, kAngles, "heart", 1);
  EXPECT_EQ(made.without, 0U);
  const TetMesh& mesh = *grid->tets;
  // Helix angles in the septum's middle and in the free walls, about the level where the surfaces stand upright.
  std::array<std::vector<double>, 3> inner, outer;  // left free wall, septum, right free wall
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    const Vec3 x = grid->frame.data_from_local(mesh.position(static_cast<CellIndex>(c), Vec4{0.25}));
    const double polar = std::atan2(std::hypot(x.x, x.y), -x.z / 1.4), around = std::atan2(x.y, x.x);
    const double radius = std::hypot(x.x, x.y, x.z / 1.4);
    if (polar < 1.25 || polar > 1.5) continue;
    const bool septum = std::abs(around)<20.0 * kDegree, free = std::abs(around)> 150.0 * kDegree;
    const Vec3 out{std::cos(around), std::sin(around), 0.0};
    const auto angle = wall_angle(WallAngle::kHelix, AngleConvention::kBayer,
                                  {.axis = {0.0, 0.0, 1.0}, .transmural = out, .fibre = made.fibres[c]});
    ASSERT_TRUE(angle.has_value());
    const auto sort_in = [&](std::size_t wall, double within, double beyond) {
      if (radius > within && radius < within + 0.13) inner[wall].push_back(*angle / kDegree);
      if (radius < beyond && radius > beyond - 0.13) outer[wall].push_back(*angle / kDegree);
    };
    if (free) sort_in(0, 1.0, 1.5);
    if (septum && radius < 1.5) sort_in(1, 1.0, 1.5);
    if (septum && radius > 2.0) sort_in(2, 2.3, 2.6);
  }
  const auto mean = [](const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
  };
  for (std::size_t wall = 0; wall < 3; ++wall) {
    ASSERT_GT(inner[wall].size(), 20U) << wall;
    ASSERT_GT(outer[wall].size(), 20U) << wall;
    // Middles of cells are an eighth of the wall from its surface; two layers of the right wall are taken, which
    // is thinner. Its cells are three times as wide as thick, all split the same way round: off by some 10 degrees.
    const double expected = wall == 2 ? 33.0 : 45.0, within = wall == 2 ? 14.0 : 9.0;
    EXPECT_NEAR(mean(inner[wall]), expected, within) << wall;
    EXPECT_NEAR(mean(outer[wall]), -expected, within) << wall;
  }
}

// The fibre turns out of the layer, too: f = cos(beta) e_c' - sin(beta) e_t, both angles linear in the depth.
TEST(FibreRule, IsTheRuleOfDosteOnTheVentricleWithinOneDegree) {
  const RuleAngles angles{.endo = 60.0 * kDegree,
                          .epi = -60.0 * kDegree,
                          .right_endo = 90.0 * kDegree,
                          .right_epi = -25.0 * kDegree,
                          .transverse_endo = -20.0 * kDegree,
                          .transverse_epi = 20.0 * kDegree};
  const Ruled fine = ruled({.wall = 10, .along = 48, .around = 120}, FibreRule::kDoste, angles, false);
  const TetMesh& mesh = *fine.grid->tets;
  double worst = 0.0, sheet_worst = 0.0;
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    const Vec3 x = fine.grid->frame.data_from_local(mesh.position(static_cast<CellIndex>(c), Vec4{0.25}));
    const Prolate at = fine.shape.coordinates(x);
    if (at.mu < 0.2) continue;
    const Mat3 axes = fine.shape.wall_axes(at);
    const double d = depth_at(fine.shape, at), alpha = linear(angles, d), beta = (-20.0 + 40.0 * d) * kDegree;
    const Vec3 along = std::cos(alpha) * axes[0] + std::sin(alpha) * axes[1];
    worst = std::max(worst, apart(fine.made.fibres[c], std::cos(beta) * along - std::sin(beta) * axes[2]));
    sheet_worst =
        std::max(sheet_worst, apart(fine.made.sheets[c], std::sin(beta) * along + std::cos(beta) * axes[2]));
  }
  RecordProperty("worst_degrees", std::to_string(worst));
  EXPECT_LT(worst, 1.0);
  EXPECT_LT(sheet_worst, 1.0);
  EXPECT_EQ(fine.made.without, 0U);
}

// Each ventricle has its own angles; in the septum both go to zero, two thirds of the way from the left.
TEST(FibreRule, DosteHasTwoThirdsOfTheSeptumFromTheLeft) {
  const RuleAngles angles{.endo = 60.0 * kDegree,
                          .epi = -60.0 * kDegree,
                          .right_endo = 80.0 * kDegree,
                          .right_epi = -25.0 * kDegree};
  const test::TwoVentricles heart(130.0 * kDegree);
  const auto grid = make_field_grid(std::span(&heart.mesh, 1), "heart", 1);
  const WallSurfaces surfaces = find_wall_surfaces(*grid, heart.mesh, "heart");
  const RuleFibres made = make_rule_fibres(*grid, surfaces, FibreRule::kDoste, angles, "heart", 1);
  EXPECT_EQ(made.without, 0U);
  const TetMesh& mesh = *grid->tets;
  // By the radius in the septum's middle, from the left (1) to the right (1.5): sums and counts of four layers.
  std::array<double, 4> sums{}, counts{};
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    const Vec3 x = grid->frame.data_from_local(mesh.position(static_cast<CellIndex>(c), Vec4{0.25}));
    const double polar = std::atan2(std::hypot(x.x, x.y), -x.z / 1.4), around = std::atan2(x.y, x.x);
    const double radius = std::hypot(x.x, x.y, x.z / 1.4);
    if (polar < 1.25 || polar > 1.5 || std::abs(around) > 20.0 * kDegree || radius > 1.5 || radius < 1.0)
      continue;
    const auto angle = wall_angle(WallAngle::kHelix, AngleConvention::kBayer,
                                  {.axis = {0.0, 0.0, 1.0},
                                   .transmural = {std::cos(around), std::sin(around), 0.0},
                                   .fibre = made.fibres[c]});
    ASSERT_TRUE(angle.has_value());
    const auto layer = std::min<std::size_t>(3, static_cast<std::size_t>((radius - 1.0) * 8.0));
    sums[layer] += *angle / kDegree;
    counts[layer] += 1.0;
  }
  // The potential of a shell falls as 1/r: phi_t = -2 + 3 (1/1 - 1/r) / (1/1 - 1/1.5), at the middles of the layers.
  for (std::size_t layer = 0; layer < 4; ++layer) {
    ASSERT_GT(counts[layer], 20.0) << layer;
    const double r = 1.0625 + 0.125 * static_cast<double>(layer), phi = -2.0 + 9.0 * (1.0 - 1.0 / r);
    const double expected = phi < 0.0 ? -30.0 * phi : -80.0 * phi;
    EXPECT_NEAR(sums[layer] / counts[layer], expected, 8.0) << layer;
  }
}

// The printed algorithm mixes frames that are turned already: quadratic in the depth, the nearer of two axes.
TEST(FibreRule, ThePrintedAlgorithmBendsTheAngle) {
  const RuleAngles narrow{.endo = 40.0 * kDegree, .epi = -40.0 * kDegree};
  const Ruled made = ruled({.wall = 6, .along = 28, .around = 72}, FibreRule::kBayerPrinted, narrow);
  const auto bent = [](double d) { return 40.0 * kDegree * (1.0 - 2.0 * d * d); };
  const Errors errors = errors_of(made, narrow, 0.3, bent);
  EXPECT_LT(errors.p95, 1.0);
  EXPECT_GT(errors_of(made, narrow, 0.3, [&](double d) { return linear(narrow, d); }).p95, 15.0);
}

}  // namespace
}  // namespace palpate
