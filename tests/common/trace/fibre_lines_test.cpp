// Fibre lines of the analytic ventricle against their closed form (field/analytic/ventricle.h).
#include "common/trace/fibre_lines.h"

#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/analytic/ventricle.h"
#include "common/field/grid/tet_mesh.h"

namespace palpate {
namespace {

std::shared_ptr<const LayeredHeart> heart_of(const VentricleCells& cells) {
  const DataSet mesh = ventricle_mesh({}, cells);
  std::vector<ArrayInfo> arrays;
  for (const DataArray& a : mesh.arrays)
    arrays.push_back({a.name, a.association, a.components, a.type, a.tuples});
  return std::make_shared<const LayeredHeart>(make_heart(mesh, choose_heart(arrays, "", "shell"), "shell"));
}

/// Distance from the exact fibre through `seed`, which lies on the layer of `lambda`: to the closest of its
/// points, sampled densely.
double distance_from_curve(const Ventricle& shape, double lambda, const Prolate& seed, const Vec3& x) {
  double best = HUGE_VAL;
  const double around = shape.coordinates(x).mu;
  constexpr int kHalf = 200;
  for (int i = -kHalf; i <= kHalf; ++i) {
    const double mu = around + 0.05 * i / kHalf;
    if (!(mu > 0.0)) continue;
    const Vec3 on =
        shape.position({lambda, mu, seed.theta + shape.turn(lambda, mu) - shape.turn(lambda, seed.mu)});
    best = std::min(best, glm::distance(on, x));
  }
  return best;
}

struct Deviation {
  double worst = 0.0;      ///< from the exact curve, in parts of the heart's size
  double off_layer = 0.0;  ///< of the depth's range
  std::size_t points = 0;
};

/// Of fibres through places on the layer `depth`, half a diagonal long each way.
Deviation deviation(const std::shared_ptr<const LayeredHeart>& heart, double depth) {
  const Ventricle shape;
  const ScalarField& layer = *heart->heart().layer;
  const double lambda = shape.lambda_inner + depth * (shape.lambda_outer - shape.lambda_inner);
  std::vector<Prolate> places;
  std::vector<Vec3> seeds;
  for (int i = 0; i < 12; ++i) {
    places.push_back({lambda, 0.6 + 0.1 * i, -3.0 + 0.5 * i});
    seeds.push_back(shape.position(places.back()));
  }
  const FibreLineResult result =
      trace_fibres(*heart, seeds, {.layer = depth, .max_length = 0.5 * layer.diagonal(), .threads = 2});
  EXPECT_EQ(result.lines.size(), 2 * seeds.size());
  Deviation found;
  CellHint hint;
  for (const Line& line : result.lines) {
    // The seed moved to the layer of the mesh, which is not the exact one: its curve is the one compared.
    Prolate seed = shape.coordinates(line.points.front().position);
    for (std::size_t p = 0; p < line.points.size(); p += 8) {
      const Vec3& x = line.points[p].position;
      found.worst = std::max(found.worst, distance_from_curve(shape, lambda, seed, x) / layer.diagonal());
      const ScalarSample s = layer.sample(x, hint);
      if (s.status == SampleStatus::kOk)
        found.off_layer = std::max(found.off_layer, std::abs(s.value - depth));
      ++found.points;
    }
  }
  return found;
}

TEST(FibreLines, FollowTheExactCurvesToAThousandthOfTheSize) {
  const auto heart = heart_of({});
  for (const double depth : {0.25, 0.54, 0.8}) {
    const Deviation found = deviation(heart, depth);
    EXPECT_GT(found.points, 500U);
    EXPECT_LT(found.worst, 1e-3) << depth;
    EXPECT_LT(found.off_layer, 1e-12) << depth;
  }
}

TEST(FibreLines, ErrorFallsAtSecondOrderWithTheMesh) {
  // A layer of points in both meshes, so that no fraction of a cell comes in.
  const double coarse = deviation(heart_of({.wall = 4, .along = 22, .around = 48}), 0.25).worst;
  const double fine = deviation(heart_of({.wall = 8, .along = 44, .around = 96}), 0.25).worst;
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.4) << coarse << " -> " << fine;
}

TEST(FibreLines, ThroughTheWallTheyStayInItsLayersHere) {
  const Ventricle shape;
  const auto heart = heart_of({.wall = 6, .along = 32, .around = 64});
  const std::vector<Vec3> seeds{shape.position({0.62, 1.0, 0.2}), shape.position({0.7, 1.4, 2.0})};
  const FibreLineResult result = trace_fibres(*heart, seeds, {.max_length = 30.0});
  ASSERT_EQ(result.lines.size(), 4U);
  for (const Line& line : result.lines) {
    EXPECT_EQ(line.end, End::kMaxLength);
    const double lambda = shape.coordinates(line.points.front().position).lambda;
    // 0.1 % of the size is some 0.12 mm, and the wall is some 10 mm thick.
    EXPECT_NEAR(shape.depth(shape.coordinates(line.points.back().position).lambda), shape.depth(lambda),
                0.02);
    EXPECT_NEAR(line.points.back().arc, 30.0, 1e-9);
  }
}

TEST(FibreLines, LinesDoNotDependOnThreadsNorOnSigns) {
  const Ventricle shape;
  const auto heart = heart_of({.wall = 2, .along = 16, .around = 32});
  std::vector<Vec3> seeds;
  for (int i = 0; i < 40; ++i) seeds.push_back(shape.position({0.6, 0.5 + 0.03 * i, 0.4 * i}));
  const auto one = trace_fibres(*heart, seeds, {.layer = 0.4, .max_length = 20.0, .threads = 1});
  const auto two = trace_fibres(*heart, seeds, {.layer = 0.4, .max_length = 20.0, .threads = 2});
  ASSERT_EQ(one.lines.size(), two.lines.size());
  for (std::size_t l = 0; l < one.lines.size(); ++l) {
    ASSERT_EQ(one.lines[l].points.size(), two.lines[l].points.size());
    const auto bytes = one.lines[l].points.size() * sizeof(LinePoint);
    EXPECT_EQ(std::memcmp(one.lines[l].points.data(), two.lines[l].points.data(), bytes), 0);
  }
}

TEST(FibreLines, GoOnFromAPlaceThatIsOnTheLayerAlready) {
  const auto heart = heart_of({.wall = 2, .along = 24, .around = 48});
  const FibreLineResult first = trace_fibres(*heart, std::vector{Ventricle().position({0.65, 1.2, 0.3})},
                                             {.layer = 0.4, .max_length = 30.0, .backward = false});
  ASSERT_EQ(first.lines.size(), 1U);
  std::vector<Vec3> seeds;
  for (const LinePoint& point : first.lines[0].points) seeds.push_back(point.position);
  ASSERT_GT(seeds.size(), 10U);
  const FibreLineResult again = trace_fibres(*heart, seeds, {.layer = 0.4, .max_length = 1.0});
  EXPECT_TRUE(again.outside_seeds.empty());
  for (const Line& line : again.lines)
    EXPECT_LT(glm::distance(line.points.front().position, seeds[line.seed]), 1e-9);
}

TEST(FibreLines, EndAtTheRimAndSayWhatLiesOutside) {
  const Ventricle shape;
  const auto heart = heart_of({.wall = 2, .along = 24, .around = 48});
  const std::vector<Vec3> seeds{shape.position({0.65, 1.8, 0.0}), Vec3{0.0}, Vec3{1e3}};
  const FibreLineResult result = trace_fibres(*heart, seeds, {.layer = 0.2, .max_length = 1e4});
  EXPECT_EQ(result.outside_seeds, (std::vector<std::uint32_t>{1, 2}));
  ASSERT_EQ(result.lines.size(), 2U);
  int at_rim = 0;
  for (const Line& line : result.lines) {
    if (line.end != End::kLeftDomain) continue;
    ++at_rim;
    EXPECT_NEAR(shape.coordinates(line.points.back().position).mu, shape.mu_base, 2e-3);
  }
  EXPECT_EQ(at_rim, 1);
  EXPECT_GT(result.errors.max, 0.0);
}

TEST(FibreLines, RefusesLayersThatAreNotThere) {
  const auto heart = heart_of({.wall = 1, .along = 4, .around = 8});
  EXPECT_THROW((void)trace_fibres(*heart, {}, {.layer = 1.5}), Error);
}

}  // namespace
}  // namespace palpate
