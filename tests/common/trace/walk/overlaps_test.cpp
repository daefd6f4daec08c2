// Blocks that overlap: which of them counts, and what lines make of it.

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "common/trace/trace.h"
#include "tests/common/trace/walk/seam_meshes.h"

namespace palpate {
namespace {

using namespace test::seams;

TEST(Overlaps, LinesGoOnInTheBlockOfAnyKindThatOverlaps) {
  for (const int kind : kBlockKinds) {
    for (const int other : kBlockKinds) {
      SCOPED_TRACE(kind);
      SCOPED_TRACE(other);
      const Field field = field_of({block_of(kind, {6, 6, 6}, {-1, -1, 0}, {1, 1, 2}),
                                    block_of(other, {7, 8, 9}, {-0.43, -0.42, 0.31}, {0.41, 0.44, 1.43})});
      EXPECT_TRUE(noted(field, "2 blocks overlap"));
      expect_helices(field, 1e-6);
    }
  }
  const Field turned = field_of({lattice({8, 8, 8}, {-1, -1, 0}, {1, 1, 2}),
                                 lattice({12, 12, 12}, {-0.4, -0.4, 0.3}, {0.4, 0.4, 1.4}, 0.3)});
  EXPECT_TRUE(noted(turned, "2 blocks overlap"));
  expect_helices(turned, 1e-6);
}

/// A block of constant velocity.
DataSet constant_block(const Index3& n, const Vec3& lower, const Vec3& upper, const Vec3& velocity) {
  DataSet block = lattice(n, lower, upper);
  std::vector<double> value;
  for (std::size_t p = 0; p < block.point_count(); ++p)
    value.insert(value.end(), {velocity.x, velocity.y, velocity.z});
  block.arrays = {make_array("velocity", Association::kPoint, 3, std::span<const double>(value))};
  return block;
}

// Both blocks are constant, and differ by a slope: a line that enters the inner one at its border or up to one outer cell
// behind it has risen by slope * width when it leaves, up to what one outer cell makes of it.
TEST(Overlaps, WhereBlocksOverlapTheFinerOneCounts) {
  constexpr double kSlope = 0.01, kCell = 0.25, kInner = 1.0;
  const Vec3 outer_flow{1.0, 0.0, 0.0}, inner_flow{1.0, kSlope, 0.0};
  const DataSet outer = constant_block(Index3(16, 8, 8), {0, -1, -1}, {4, 1, 1}, outer_flow);
  const Vec3 lower{1.53, -0.52, -0.49}, upper{1.53 + kInner, 0.48, 0.51};
  const auto inner = [&](int n) { return constant_block(Index3(n), lower, upper, inner_flow); };
  std::vector<Vec3> from;
  for (int i = 0; i < 40; ++i) from.emplace_back(0.1, 0.01 * i - 0.2, 0.2 - 0.011 * i);
  // The order in the file does not decide.
  for (const bool inner_first : {false, true}) {
    SCOPED_TRACE(inner_first);
    const Field field = field_of(inner_first ? std::vector{inner(9), outer} : std::vector{outer, inner(9)});
    EXPECT_TRUE(noted(field, "whose values differ by up to 0.01 (1 % of the largest there)"));
    CellHint hint;
    for (double x = 0.01; x < 4.0; x += 0.013) {
      const VectorSample here = field->sample({x, 0.013, 0.021}, hint);
      ASSERT_EQ(here.status, SampleStatus::kOk);
      EXPECT_NEAR(here.value.y, x > lower.x && x < upper.x ? kSlope : 0.0, 1e-12) << x;
    }
    for (const Integrator integrator : {Integrator::kExact, Integrator::kDp54}) {
      TraceOptions options;
      options.integrator = integrator;
      options.threads = 1;
      for (const Line& line : trace_lines(*field, from, options).lines) {
        const LinePoint& last = line.points.back();
        EXPECT_EQ(line.end, End::kLeftDomain);
        EXPECT_NEAR(last.position.x, 4.0, 1e-9);
        const double rise = last.position.y - from[line.seed].y;
        EXPECT_LE(rise, kSlope * kInner + 1e-9);
        EXPECT_GE(rise, kSlope * (kInner - 2.0 * kCell) - 1e-9);
        EXPECT_LE(std::abs(rise - kSlope * kInner), last.error) << "what the border costs is stated";
        EXPECT_LT(last.error, 2.0 * kSlope);
      }
    }
  }
  // Of an inner block with larger cells nothing is left where the outer one is.
  const Field coarse = field_of({inner(2), outer});
  TraceOptions options;
  options.threads = 1;
  for (const Line& line : trace_lines(*coarse, from, options).lines) {
    EXPECT_NEAR(line.points.back().position.y, from[line.seed].y, 1e-12);
    EXPECT_LT(line.points.back().error, 1e-9);
  }
}

TEST(Overlaps, OfBlocksAsFineTheFirstCounts) {
  const Vec3 first_flow{1.0, 0.0, 0.0}, second_flow{1.0, 0.02, 0.0};
  const auto block = [](double begin, const Vec3& flow) {
    return constant_block(Index3(8, 8, 8), {begin, -1, -1}, {begin + 2.0, 1, 1}, flow);
  };
  for (const bool turned : {false, true}) {
    const DataSet left = block(0.0, turned ? second_flow : first_flow);
    const DataSet right = block(1.1, turned ? first_flow : second_flow);
    const Field field = field_of(turned ? std::vector{right, left} : std::vector{left, right});
    CellHint hint;
    for (double x = 0.013; x < 3.1; x += 0.01) {
      const bool first = turned ? x > 1.1 : x < 2.0;
      EXPECT_NEAR(field->sample({x, 0.03, 0.04}, hint).value.y, first ? 0.0 : 0.02, 1e-12) << x;
    }
  }
}

TEST(Overlaps, PartsOfOneBlockThatOverlapHaveTheSameOrder) {
  OwnPoints cells(0.0, 0.0);
  cells.add_box(12, {-1, -1, 0}, {1, 1, 2}, {8, 8, 8});
  cells.add_box(14, {-0.41, -0.42, 0.3}, {0.43, 0.44, 1.41}, {9, 9, 9});
  const Field field = field_of({cells.take()});
  EXPECT_TRUE(noted(field, "2 parts overlap"));
  expect_helices(field, 1e-6);
}

}  // namespace
}  // namespace palpate
