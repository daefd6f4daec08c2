// What regions, cut-offs and bounds of length do to a bundle of straight lines.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "common/trace/tract/trace_tracts.h"
#include "tests/common/trace/tract/tensor_images.h"

namespace palpate {
namespace {

constexpr Index3 kPoints{21, 11, 11};

/// Along x; FA falls from 0.8 at x = 0 to 0.05 at x = 20 where `fading`.
std::shared_ptr<const TensorField> straight(bool fading = false) {
  return test::tensor_field<double>({kPoints, Vec3{0.0}, Mat3{1.0}}, [&](const Vec3& x) {
    const double rest = fading ? 0.3 + 0.065 * x.x : 0.3;
    return Mat3{Vec3{1.7, 0.0, 0.0}, Vec3{0.0, rest, 0.0}, Vec3{0.0, 0.0, rest}};
  });
}

TractResult trace(const TensorField& field, const TractOptions& options,
                  const Vec3& seed = {10.2, 5.0, 5.0}) {
  const std::vector<Vec3> seeds{seed};
  return trace_tracts(field, seeds, options);
}

TractRegion ball(double x, double radius) { return TractRegion(Sphere{{x, 5.0, 5.0}, radius}); }

TractRegion slab(double from, double to) {
  std::vector<float> values;
  for (int k = 0; k < kPoints.z; ++k) {
    for (int j = 0; j < kPoints.y; ++j) {
      for (int i = 0; i < kPoints.x; ++i) values.push_back(i >= from && i <= to ? 1.0F : 0.0F);
    }
  }
  const DataArray array = make_array("mask", Association::kPoint, 1, std::span<const float>(values));
  return TractRegion(
      std::make_shared<const VoxelMask>(UniformTopology{kPoints, Vec3{0.0}, Mat3{1.0}}, array));
}

TEST(TractRegions, AMaskReachesHalfWayToItsNeighbours) {
  const TractRegion mask = slab(4, 6);
  EXPECT_TRUE(mask.contains({5.0, 5.0, 5.0}));
  EXPECT_TRUE(mask.contains({6.45, 5.0, 5.0}));
  EXPECT_FALSE(mask.contains({6.55, 5.0, 5.0}));
  EXPECT_FALSE(mask.contains({5.0, 5.0, 50.0}));
}

TEST(TractRegions, LinesMustEnterEveryIncludeAndNoExclude) {
  const auto field = straight();
  TractOptions options;
  options.include = {ball(15.0, 1.0), slab(2, 4)};
  EXPECT_EQ(trace(*field, options).lines.line_count(), 1U);
  options.include.emplace_back(Sphere{{10.0, 9.0, 5.0}, 1.0});
  EXPECT_EQ(trace(*field, options).lines.line_count(), 0U);
  EXPECT_EQ(trace(*field, options).dropped.not_included, 1U);
  options.include.clear();
  options.exclude = {ball(15.0, 1.0)};
  EXPECT_EQ(trace(*field, options).lines.line_count(), 0U);
  EXPECT_EQ(trace(*field, options).dropped.excluded, 1U);
  options.exclude = {TractRegion(Sphere{{10.0, 9.0, 5.0}, 1.0})};
  EXPECT_EQ(trace(*field, options).lines.line_count(), 1U);
}

TEST(TractRegions, LinesEndWhereTheyEnterAStopRegion) {
  const auto field = straight();
  TractOptions options;
  options.stop = {ball(15.0, 1.0)};
  const TractResult result = trace(*field, options);
  ASSERT_EQ(result.lines.line_count(), 1U);
  EXPECT_EQ(result.ends[0], (std::array{End::kLeftDomain, End::kStoppedByRule}));
  // Points lie a quarter of a voxel apart: the first one inside ends the line.
  EXPECT_GE(result.lines.points.back().x, 14.0F);
  EXPECT_LT(result.lines.points.back().x, 14.2501F);
}

TEST(TractRegions, AStopRegionAroundTheSeedCountsOnceTheLineHasLeftIt) {
  const auto field = straight();
  TractOptions options;
  options.stop = {ball(10.0, 2.0), ball(16.0, 1.0)};
  const TractResult result = trace(*field, options);
  ASSERT_EQ(result.lines.line_count(), 1U);
  EXPECT_NEAR(result.lines.points.front().x, 0.0, 0.01);
  EXPECT_NEAR(result.lines.points.back().x, 15.1, 0.13);
}

TEST(TractRegions, TheCutOffIsLocated) {
  const auto field = straight(true);
  for (const TractMeasure measure : {TractMeasure::kFa, TractMeasure::kLinear}) {
    TractOptions options;
    options.measure = measure;
    options.cutoff = 0.35;
    const TractResult result = trace(*field, options, {2.0, 5.0, 5.0});
    ASSERT_EQ(result.lines.line_count(), 1U);
    EXPECT_EQ(result.ends[0][1], End::kBelowCutoff);
    const double x = result.lines.points.back().x, rest = 0.3 + 0.065 * x;
    const Vec3 values{1.7, rest, rest};
    const double there =
        measure == TractMeasure::kFa ? fractional_anisotropy(values) : anisotropy(values).linear;
    EXPECT_NEAR(there, 0.35, 1e-4);
    EXPECT_EQ(trace(*field, options, {18.0, 5.0, 5.0}).dropped.below_cutoff, 1U);
  }
}

TEST(TractRegions, LengthIsBoundedOverBothSides) {
  const auto field = straight();
  TractOptions options;
  options.max_length = 12.0;
  const TractResult result = trace(*field, options);
  ASSERT_EQ(result.lines.line_count(), 1U);
  const auto line = result.lines.line(0);
  EXPECT_NEAR(line.back().x - line.front().x, 12.0, 1e-5);
  EXPECT_EQ(result.ends[0], (std::array{End::kMaxLength, End::kLeftDomain}));
  options.max_length = 0.0;
  options.min_length = 20.5;
  EXPECT_EQ(trace(*field, options).dropped.too_short, 1U);
}

}  // namespace
}  // namespace palpate
