#include "common/trace/growing_line.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "common/trace/trace.h"
#include "tests/common/trace/helix_field.h"
#include "tests/common/trace/linear_fields.h"
#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

using Side = GrowingLine::Side;

const Mat3 kCircle = rows(0, -1, 0, 1, 0, 0, 0, 0, 0);

/// A line with what it needs to live. The helix fields are their own frame L.
struct Grown {
  explicit Grown(std::shared_ptr<const VectorField> flow, const GrowthLimits& limits,
                 double tolerance = 1e-10)
      : field(std::move(flow)),
        factory(*field, default_integrator(*field), {.tolerance = tolerance, .rest_distance = 1e-6}, 1),
        line(*field, factory, limits) {}

  /// @param seed in data coordinates.
  [[nodiscard]] bool start(const Vec3& seed) { return line.start(field->frame().local_from_data(seed)); }
  /// Grows both sides to their ends.
  void grow() {
    for (const Side side : {Side::kDownstream, Side::kUpstream}) {
      for (int pieces = 0; !line.end(side) && pieces < 100'000; ++pieces) line.grow(side);
    }
  }

  std::shared_ptr<const VectorField> field;
  WalkFactory factory;
  GrowingLine line;
};

TEST(GrowingLine, BothSidesLieOnTheHelix) {
  constexpr double kRise = 0.25;
  const Helix helix{{0.9, 0.2, -0.1}, kRise};
  Grown grown(helix_flow(kRise), {.max_length = 5.0, .max_gap = 1e-8});
  ASSERT_TRUE(grown.line.start(helix.seed));
  grown.grow();
  const GrowingLine& line = grown.line;
  EXPECT_EQ(line.end(Side::kDownstream), End::kMaxLength);
  EXPECT_EQ(line.end(Side::kUpstream), End::kMaxLength);
  EXPECT_GE(line.node(line.last()).arc, 5.0);
  EXPECT_LE(line.node(line.first()).arc, -5.0);
  EXPECT_EQ(line.node(0).position, helix.seed);
  for (int i = line.first(); i <= line.last(); ++i) {
    const LineNode& node = line.node(i);
    EXPECT_LE(glm::distance(node.position, helix.at_arc(node.arc)), 5e-9) << i;
    EXPECT_NEAR(node.time, node.arc / helix.speed(), 5e-9);
    EXPECT_NEAR(node.speed, helix.speed(), 1e-9);
    EXPECT_LE(glm::distance(node.tangent, grown.field->analytic()->velocity(node.position) / helix.speed()),
              1e-8)
        << "along the flow on either side";
    EXPECT_LE(node.gap, 1e-8);
  }
  double worst = 0.0;
  for (int i = line.first(); i < line.last(); ++i) {
    const HermitePiece piece = line.piece(i);
    ASSERT_GT(piece.length, 0.0);
    for (int k = 0; k <= 8; ++k) {
      const double s = piece.length * k / 8;
      worst = std::max(worst, glm::distance(piece.at(s), helix.at_arc(line.node(i).arc + s)));
    }
  }
  EXPECT_LE(worst, 2e-8) << "between the nodes as well";
}

// On a coarse mesh the tracer's pieces are long and its lines exact: the gap of a cubic is then its distance
// from the circle.
TEST(GrowingLine, GapsAreWhatTheyAreSaidToBe) {
  Grown grown(on_tetrahedra(kCircle, Vec3{0.0}, 3, 0.2, 3), {.max_length = 50.0, .max_gap = 1e-3});
  ASSERT_TRUE(grown.start({0.8, 0.0, 0.3}));
  grown.grow();
  const GrowingLine& line = grown.line;
  const double radius = std::hypot(line.node(0).position.x, line.node(0).position.y);
  double largest = 0.0;
  for (int i = line.first(); i < line.last(); ++i) {
    const HermitePiece piece = line.piece(i);
    double off = 0.0;
    for (int k = 1; k < 64; ++k) {
      const Vec3 x = piece.at(piece.length * k / 64);
      off = std::max(off, std::abs(std::hypot(x.x, x.y) - radius));
    }
    EXPECT_NEAR(off, line.gap(i), 0.02 * line.gap(i) + 1e-14) << i;
    largest = std::max(largest, line.gap(i));
  }
  EXPECT_GT(largest, 1e-5) << "the pieces are long enough for this to say something";
  EXPECT_LE(largest, 1e-3);
}

TEST(GrowingLine, ANarrowerGapGivesMoreNodes) {
  const auto grow = [](double max_gap) {
    Grown grown(on_tetrahedra(kCircle, Vec3{0.0}, 3, 0.2, 3), {.max_length = 50.0, .max_gap = max_gap});
    EXPECT_TRUE(grown.start({0.8, 0.0, 0.3}));
    grown.grow();
    double largest = 0.0;
    for (int i = grown.line.first(); i < grown.line.last(); ++i) {
      largest = std::max(largest, grown.line.gap(i));
    }
    EXPECT_LE(largest, max_gap);
    return grown.line.last();
  };
  EXPECT_GT(grow(1e-8), 3 * grow(1e-4));
}

TEST(GrowingLine, FollowsTheExactLinesOfATetrahedralMesh) {
  const Mat3 a = rows(-0.25, -1.0, 0.0, 1.0, -0.25, 0.0, 0.0, 0.0, 0.5);
  const Vec3 seed{0.3, 0.1, 0.2};
  Grown grown(on_tetrahedra(a, Vec3{0.0}, 4, 0.2, 3), {.max_length = 2.0, .max_gap = 1e-8});
  ASSERT_TRUE(grown.start(seed));
  grown.grow();
  const GrowingLine& line = grown.line;
  const LocalFrame& frame = grown.field->frame();
  const auto exact = [&](double local_time) {
    return frame.local_from_data(exact_line(a, Vec3{0.0}, seed, local_time * frame.time_scale()));
  };
  ASSERT_GT(line.last(), 5);
  ASSERT_LT(line.first(), -5);
  for (int i = line.first(); i <= line.last(); ++i) {
    EXPECT_LE(glm::distance(line.node(i).position, exact(line.node(i).time)), 1e-12) << i;
  }
  for (int i = line.first(); i < line.last(); ++i) {
    // How far the middle is from the line, by ternary search: the distance has one minimum.
    const HermitePiece piece = line.piece(i);
    const Vec3 middle = piece.at(0.5 * piece.length);
    double low = line.node(i).time, high = line.node(i + 1).time;
    for (int k = 0; k < 60; ++k) {
      const double left = low + (high - low) / 3.0, right = high - (high - low) / 3.0;
      const bool go_left = glm::distance(exact(left), middle) < glm::distance(exact(right), middle);
      (go_left ? high : low) = go_left ? right : left;
    }
    EXPECT_LE(glm::distance(exact(low), middle), 1.1e-8) << i;
  }
}

TEST(GrowingLine, CountsArcAndTimeFromWhereItIsTold) {
  const Helix helix{{1.0, 0.0, 0.0}, 0.25};
  Grown grown(helix_flow(0.25), {.max_length = 1.0, .max_gap = 1e-8});
  ASSERT_TRUE(grown.line.start(helix.seed, 10.0, -3.0));
  grown.grow();
  for (int i = grown.line.first(); i <= grown.line.last(); ++i) {
    const LineNode& node = grown.line.node(i);
    EXPECT_LE(glm::distance(node.position, helix.at_arc(node.arc - 10.0)), 1e-8);
    EXPECT_NEAR(node.time + 3.0, (node.arc - 10.0) / helix.speed(), 1e-8);
  }
}

std::optional<End> end_of(const Mat3& a, const Vec3& seed, Side side) {
  Grown grown(on_tetrahedra(a, Vec3{0.0}, 5, 0.2, 3), {.max_length = 50.0, .max_gap = 1e-7});
  EXPECT_TRUE(grown.start(seed));
  grown.grow();
  const int at = side == Side::kDownstream ? grown.line.last() : grown.line.first();
  EXPECT_TRUE(is_finite(grown.line.node(at).position));
  EXPECT_EQ(grown.line.grow(side), 0) << "it does not grow past its end";
  return grown.line.end(side);
}

TEST(GrowingLine, SaysWhyASideEnds) {
  const Mat3 shear = rows(0, 1, 0, 0, 0, 0, 0, 0, 0);
  const Mat3 sink = rows(-1, 0, 0, 0, -2, 0, 0, 0, -1);
  for (const Side side : {Side::kDownstream, Side::kUpstream}) {
    EXPECT_EQ(end_of(kCircle, {0.5, 0.0, 0.1}, side), End::kLoop);
    EXPECT_EQ(end_of(shear, {0.1, 0.5, 0.1}, side), End::kLeftDomain);
  }
  EXPECT_EQ(end_of(sink, {0.5, 0.4, 0.3}, Side::kDownstream), End::kStagnation);
  EXPECT_EQ(end_of(sink, {0.5, 0.4, 0.3}, Side::kUpstream), End::kLeftDomain);
}

TEST(GrowingLine, EndsOnTheBorder) {
  const Mat3 shear = rows(0, 1, 0, 0, 0, 0, 0, 0, 0);
  Grown grown(on_tetrahedra(shear, Vec3{0.0}, 5, 0.2, 3), {.max_length = 50.0, .max_gap = 1e-7});
  ASSERT_TRUE(grown.start({0.25, 0.5, 0.125}));
  grown.grow();
  const LocalFrame& frame = grown.field->frame();
  EXPECT_LE(glm::distance(frame.data_from_local(grown.line.node(grown.line.last()).position),
                          Vec3(1.0, 0.5, 0.125)),
            1e-12);
  EXPECT_LE(glm::distance(frame.data_from_local(grown.line.node(grown.line.first()).position),
                          Vec3(-1.0, 0.5, 0.125)),
            1e-12);
}

TEST(GrowingLine, NeverHasMoreNodesThanRoom) {
  constexpr int kRoom = 40;
  Grown grown(helix_flow(0.01), {.max_length = 1e3, .max_gap = 1e-10, .capacity = kRoom});
  ASSERT_TRUE(grown.line.start({1.0, 0.0, 0.0}));
  grown.grow();
  EXPECT_EQ(grown.line.end(Side::kDownstream), End::kMaxSteps);
  EXPECT_LE(grown.line.last(), kRoom);
  EXPECT_GE(grown.line.first(), -kRoom);
}

TEST(GrowingLine, IsEmptyWhereThereIsNoData) {
  Grown grown(helix_flow(0.25), {.max_length = 1.0, .max_gap = 1e-8});
  ASSERT_TRUE(grown.line.start({1.0, 0.0, 0.0}));
  grown.grow();
  for (const Vec3& outside : {Vec3{3.0, 0.0, 0.0}, Vec3{NAN, 0.0, 0.0}}) {
    EXPECT_FALSE(grown.line.start(outside));
    EXPECT_EQ(grown.line.first(), 0);
    EXPECT_EQ(grown.line.last(), 0);
    EXPECT_EQ(grown.line.grow(Side::kDownstream), 0);
  }
  EXPECT_TRUE(grown.line.start({1.0, 0.0, 0.0})) << "and begins again where there is some";
  EXPECT_GT(grown.line.grow(Side::kUpstream), 0);
}

TEST(GrowingLine, AllocatesNothing) {
  Grown formula(helix_flow(0.25), {.max_length = 3.0, .max_gap = 1e-8});
  Grown mesh(on_tetrahedra(rows(0, -1, 0, 1, 0, 0, 0, 0, 0.5), Vec3{0.0}, 5, 0.2, 3),
             {.max_length = 3.0, .max_gap = 1e-8});
  for (Grown* const grown : {&formula, &mesh}) {
    const AllocationGuard guard;
    bool started = true;
    for (const double x : {0.5, 0.25, 0.75, 9.0, 0.5}) {
      started = grown->start({x, 0.1, 0.1}) && started;
      grown->grow();
    }
    EXPECT_EQ(guard.count(), 0U);
    EXPECT_FALSE(started) << "one of the seeds lies outside";
  }
}

}  // namespace
}  // namespace palpate::test
