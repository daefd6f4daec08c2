// Why lines end, and the events along them: each reason, on each kind of walk.

#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/trace/trace.h"
#include "tests/common/trace/linear_fields.h"
#include "tests/support/sampled.h"

namespace palpate {
namespace {

using Field = std::shared_ptr<const VectorField>;
using test::rows;

/// The linear field on a uniform grid (whose trilinear interpolant is exact for it), with bad points if
/// asked.
Field on_boxes(const Mat3& a, const Vec3& c, int points = 9, std::size_t bad_point = SIZE_MAX) {
  std::vector<double> values;
  const double h = 2.0 / (points - 1);
  for (int k = 0; k < points; ++k) {
    for (int j = 0; j < points; ++j) {
      for (int i = 0; i < points; ++i) {
        const Vec3 v = a * (Vec3{-1.0 + h * i, -1.0 + h * j, -1.0 + h * k} - c);
        for (int axis = 0; axis < 3; ++axis) values.push_back(v[axis]);
      }
    }
  }
  if (bad_point != SIZE_MAX) values[3 * bad_point] = NAN;
  DataSet block;
  block.topology = UniformTopology{.points = Index3{points}, .origin = Vec3{-1.0}, .axes = Mat3{h}};
  block.arrays.push_back(make_array("velocity", Association::kPoint, 3, std::span<const double>(values)));
  const ArrayInfo info{"velocity", Association::kPoint, 3, ScalarType::kFloat64, values.size() / 3};
  return make_vector_field({block}, choose_vector({info}, "velocity", "boxes"), "boxes");
}

struct Way {
  std::string name;
  Field field;
  Integrator integrator;
};

std::vector<Way> ways(const Mat3& a, const Vec3& c) {
  const Field tets = test::on_tetrahedra(a, c, 6, 0.3, 7);
  const Field boxes = on_boxes(a, c);
  const Field formula = make_vector_field(std::make_shared<test::LinearField>(a, c));
  std::vector<Way> all{{"exact", tets, Integrator::kExact}};
  for (const Integrator i :
       {Integrator::kBs32, Integrator::kRk34, Integrator::kDp54, Integrator::kRodas4, Integrator::kRk4}) {
    const std::string name{name_of(i)};
    all.push_back({name + " on tetrahedra", tets, i});
    all.push_back({name + " on boxes", boxes, i});
    all.push_back({name + " on a formula", formula, i});
  }
  return all;
}

TraceResult traced(const Way& way, const std::vector<Vec3>& seeds, TraceOptions options = {}) {
  options.integrator = way.integrator;
  options.threads = 1;
  return trace_lines(*way.field, seeds, options);
}

TEST(Ends, LeaveTheDomainOnItsBorder) {
  for (const Way& way : ways(rows(1, 0, 0, 0, 2, 0, 0, 0, -1), {0.1, 0.05, 0.0})) {
    const TraceResult result = traced(way, test::random_seeds(20, 0.8, 1));
    for (const Line& line : result.lines) {
      ASSERT_EQ(line.end, End::kLeftDomain) << way.name;
      const Vec3 x = glm::abs(line.points.back().position);
      EXPECT_NEAR(std::max(x.x, std::max(x.y, x.z)), 1.0, 1e-9) << way.name;
    }
    EXPECT_EQ(result.ends[static_cast<std::size_t>(End::kLeftDomain)], 20u);
  }
}

TEST(Ends, StagnateWithinTheToleranceOfASink) {
  const Vec3 sink{0.1, 0.05, 0.02};
  for (const Mat3& a : {rows(-1, 0, 0, 0, -2, 0, 0, 0, -3), rows(-1, -6, 0, 6, -1, 0, 0, 0, -2)}) {
    for (const Way& way : ways(a, sink)) {
      // Steps of a fixed length circle a focus at a distance of their own; towards a node they turn round.
      if (way.integrator == Integrator::kRk4 && a[0][1] != 0.0) continue;
      const TraceResult result = traced(way, test::random_seeds(10, 0.5, 1));
      for (const Line& line : result.lines) {
        ASSERT_EQ(line.end, End::kStagnation) << way.name << " " << name_of(line.end);
        const double reach =
            way.integrator == Integrator::kRk4 ? 0.3 : 1e-5;  // a fixed step gets no nearer than itself
        EXPECT_LE(glm::distance(line.points.back().position, sink), reach) << way.name;
      }
    }
  }
}

// Next to the sink the direction is rounding, by more than the tolerance: no step is short enough for it.
TEST(Ends, StagnateWhereTheDirectionIsRounding) {
  const Vec3 sink{0.1, 0.05, 0.02};
  for (const Way& way : ways(rows(-2, 1, 0.5, 0.25, -1, 0.75, 0, 0.5, -1.5), sink)) {
    // Lower orders rightly need ever more steps.
    if (way.name != "dp54 on boxes" && way.name != "dp54 on a formula") continue;
    TraceOptions options;
    options.tolerance = 1e-11;
    for (const Line& line : traced(way, test::random_seeds(40, 0.5, 1), options).lines) {
      EXPECT_EQ(line.end, End::kStagnation) << way.name << " " << name_of(line.end);
      EXPECT_LE(glm::distance(line.points.back().position, sink), 1e-9) << way.name;
    }
  }
}

TEST(Ends, StagnateAtAWallWhereTheFlowRests) {
  // v = (z, 0, -z): straight lines that never arrive at z = -1 + 1: the plane z = 0 is at rest.
  for (const Way& way : ways(rows(0, 0, 1, 0, 0, 0, 0, 0, -1), {0, 0, 0})) {
    if (way.integrator == Integrator::kRk4) continue;
    const TraceResult result = traced(way, {{-0.5, 0.1, 0.3}, {-0.6, -0.2, -0.3}});
    for (const Line& line : result.lines) {
      ASSERT_EQ(line.end, End::kStagnation) << way.name << " " << name_of(line.end);
      EXPECT_NEAR(line.points.back().position.z, 0.0, 1e-5) << way.name;
    }
  }
}

TEST(Ends, StayWhereNothingMoves) {
  for (const Way& way : ways(rows(0, 0, 0, 0, 0, 0, 0, 0, 0), {0, 0, 0})) {
    const TraceResult result = traced(way, {{0.1, 0.2, 0.3}});
    ASSERT_EQ(result.lines.size(), 1u);
    EXPECT_EQ(result.lines[0].end, End::kStagnation) << way.name;
    EXPECT_EQ(result.lines[0].points.size(), 1u);
  }
}

TEST(Ends, CloseALoop) {
  for (const Way& way : ways(rows(0, -2, 0, 2, 0, 0, 0, 0, 0), {0.03, 0.02, 0})) {
    const TraceResult result = traced(way, {{0.5, 0.0, 0.1}, {0.1, -0.3, -0.2}});
    for (const Line& line : result.lines) {
      EXPECT_EQ(line.end, End::kLoop) << way.name << " " << name_of(line.end);
      // At most three turns and a bit.
      const double radius = glm::length(Vec2(line.points.front().position) - Vec2(0.03, 0.02));
      EXPECT_LE(line.points.back().arc, 4.0 * 2.0 * std::numbers::pi * radius) << way.name;
    }
  }
}

TEST(Ends, DoNotTakeASlowSpiralForALoop) {
  for (const Way& way : ways(rows(-0.001, -2, 0, 2, -0.001, 0, 0, 0, 0), {0.03, 0.02, 0})) {
    if (way.integrator == Integrator::kRk4) continue;
    TraceOptions options;
    options.tolerance = 1e-8;
    for (const Line& line : traced(way, {{0.5, 0.0, 0.1}}, options).lines) {
      EXPECT_EQ(line.end, End::kMaxLength) << way.name << " " << name_of(line.end);
    }
  }
}

TEST(Ends, StopAtALengthATimeAndANumberOfSteps) {
  for (const Way& way : ways(rows(0, -2, 0, 2, 0, 0, 0, 0, 0.25), {0.03, 0.02, -0.5})) {
    TraceOptions options;
    options.max_length = 0.777;
    const Line by_length = traced(way, {{0.5, 0.0, 0.1}}, options).lines.at(0);
    EXPECT_EQ(by_length.end, End::kMaxLength) << way.name;
    EXPECT_NEAR(by_length.points.back().arc, 0.777, 1e-12) << way.name;

    options = {};
    options.max_time = 0.321;
    options.backward = true;
    for (const Line& line : traced(way, {{0.5, 0.0, 0.1}}, options).lines) {
      EXPECT_EQ(line.end, End::kMaxTime) << way.name;
      const double sign = line.direction == TraceDirection::kForward ? 1.0 : -1.0;
      EXPECT_NEAR(line.points.back().time, sign * 0.321, 1e-11) << way.name;
    }

    options = {};
    options.max_steps = 5;
    const Line by_steps = traced(way, {{0.5, 0.0, 0.1}}, options).lines.at(0);
    EXPECT_EQ(by_steps.end, End::kMaxSteps) << way.name;
  }
}

TEST(Ends, StopWhereARuleCrossesZeroEvenTwiceInAPiece) {
  const Vec3 center{0.0, 0.5, 0.1};
  // A thin ball in the way of a rotation: entered and left within one step of most methods.
  const StopRule ball{[&](const Vec3& x) { return glm::distance(x, center) - 0.02; }};
  const StopRule plane{[](const Vec3& x) { return x.y - 0.25; }};
  for (const Way& way : ways(rows(0, -2, 0, 2, 0, 0, 0, 0, 0), {0, 0, 0})) {
    TraceOptions options;
    if (way.integrator == Integrator::kRk4) options.step = 0.05;
    options.stop_rules = {ball};
    const Line in_ball = traced(way, {{0.5, 0.0, 0.1}}, options).lines.at(0);
    EXPECT_EQ(in_ball.end, End::kStoppedByRule) << way.name << " " << name_of(in_ball.end);
    EXPECT_NEAR(ball.level(in_ball.points.back().position), 0.0, 1e-6) << way.name;
    EXPECT_LT(in_ball.points.back().position.x, 0.05) << way.name;
    options.stop_rules = {ball, plane};
    const Line at_plane = traced(way, {{0.5, 0.0, 0.1}}, options).lines.at(0);
    EXPECT_EQ(at_plane.end, End::kStoppedByRule) << way.name;
    EXPECT_NEAR(at_plane.points.back().position.y, 0.25, 1e-9) << way.name;
  }
}

TEST(Ends, StopAtBadDataAndNeverPassOnWhatIsNotANumber) {
  constexpr int kPoints = 9;
  const std::size_t bad = 6 + kPoints * (4 + kPoints * 4);  // (0.5, 0, 0)
  const Field field = on_boxes(rows(0, 0, 0, 0, 0, 0, 0, 0, 0), {0, 0, 0}, kPoints);
  const Field holed = on_boxes(rows(0.25, 0, 0, 0, 0, 0, 0, 0, 0), {-2, 0, 0}, kPoints, bad);
  for (const Integrator integrator : {Integrator::kRk4, Integrator::kDp54, Integrator::kRodas4}) {
    TraceOptions options;
    options.integrator = integrator;
    const std::vector<Vec3> seeds{{-0.9, 0.05, 0.05}, {-0.9, 0.7, 0.7}};
    const TraceResult result = trace_lines(*holed, seeds, options);
    ASSERT_EQ(result.lines.size(), 2u);
    EXPECT_EQ(result.lines[0].end, End::kBadData) << name_of(integrator);
    EXPECT_NEAR(result.lines[0].points.back().position.x, 0.25, 1e-9);
    EXPECT_EQ(result.lines[1].end, End::kLeftDomain) << name_of(integrator);
    for (const Line& line : result.lines) {
      for (const LinePoint& p : line.points) {
        EXPECT_TRUE(is_finite(p.position) && std::isfinite(p.time) && std::isfinite(p.error) &&
                    p.error > 0.0);
      }
    }
  }
}

TEST(Ends, CountSeedsOutsideAndMakeNoLineOfThem) {
  for (const Way& way : ways(rows(1, 0, 0, 0, 1, 0, 0, 0, 1), {0, 0, 0})) {
    const TraceResult result = traced(way, {{2, 0, 0}, {0.5, 0, 0}, {NAN, 0, 0}});
    EXPECT_EQ(result.outside_seeds, (std::vector<std::uint32_t>{0, 2})) << way.name;
    ASSERT_EQ(result.lines.size(), 1u);
    EXPECT_EQ(result.lines[0].seed, 1u);
  }
}

// A steady climb along z with a rotation of any stiffness: the spiral's turns are many, its lines end.
TEST(Ends, StiffRotationsAndBoundaryLayersEndInBoundedWork) {
  for (const double rate : {1e3, 1e6, 1e9, 1e12}) {
    const Field tets =
        test::on_tetrahedra(rows(-1, -rate, 0, rate, -1, 0, 0, 0, 0.5), {0, 0, -1.5}, 4, 0.2, 3);
    const Field layer =
        test::on_tetrahedra(rows(-rate, 0, 0, 0, -1, 0, 0, 0, 0.5), {0.1, 0.1, -1.5}, 4, 0.2, 3);
    TraceOptions options;
    options.max_steps = 20000;
    for (const Field& field : {tets, layer}) {
      const TraceResult result = trace_lines(*field, test::random_seeds(4, 0.5, 8), options);
      EXPECT_EQ(result.lines.size(), 4u);
      for (const Line& line : result.lines) {
        for (const LinePoint& p : line.points) ASSERT_TRUE(is_finite(p.position) && std::isfinite(p.arc));
      }
    }
    // Through the layer the line leaves by the top, where the slow manifold leads.
    const TraceResult result = trace_lines(*layer, test::random_seeds(4, 0.5, 8), options);
    EXPECT_EQ(result.ends[static_cast<std::size_t>(End::kLeftDomain)], 4u) << rate;
  }
}

// Seeds on vertices, edges and faces of the mesh, and flow along them.
TEST(Ends, SeedsOnVerticesEdgesAndFacesAreFollowedToTheBorder) {
  const Field field = test::on_tetrahedra(rows(0, 0, 0, 0, 0, 0, 0, 0, 0.25), {0, 0, -3}, 5, 0.0, 1);
  std::vector<Vec3> seeds;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      for (const double z : {-1.0, -0.75, -0.5, 0.0}) seeds.push_back({-1.0 + 0.5 * i, -1.0 + 0.5 * j, z});
    }
  }
  for (int i = 0; i < 4; ++i) seeds.push_back({-0.75 + 0.5 * i, -0.75 + 0.5 * i, -0.9});
  TraceOptions options;
  for (const Integrator integrator : {Integrator::kExact, Integrator::kDp54, Integrator::kRodas4}) {
    options.integrator = integrator;
    const TraceResult result = trace_lines(*field, seeds, options);
    ASSERT_EQ(result.lines.size(), seeds.size());
    for (const Line& line : result.lines) {
      EXPECT_EQ(line.end, End::kLeftDomain) << name_of(integrator) << " seed " << line.seed;
      const Vec3 x = line.points.back().position, s = seeds[line.seed];
      EXPECT_NEAR(x.z, 1.0, 1e-9) << name_of(integrator) << " seed " << line.seed;
      EXPECT_NEAR(x.x, s.x, 1e-9);
      EXPECT_NEAR(x.y, s.y, 1e-9);
    }
  }
}

TEST(Ends, CancelStopsSoonAndSaysSo) {
  const Field field = test::on_tetrahedra(rows(0, -2, 0, 2, 0, 0, 0, 0, 0), {0.03, 0.02, 0}, 6, 0.3, 7);
  Progress progress;
  TraceOptions options;
  options.max_length = 1e9;
  options.integrator = Integrator::kDp54;
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    progress.cancel();
  });
  const std::vector<Vec3> seeds(2'000'000, Vec3{0.5, 0.0, 0.1});
  EXPECT_THROW((void)trace_lines(*field, seeds, options, &progress), Cancelled);
  later.join();
}

TEST(Ends, OptionsThatMakeNoSenseAreRefused) {
  const Field boxes = on_boxes(rows(1, 0, 0, 0, 1, 0, 0, 0, 1), {0, 0, 0});
  const std::vector<Vec3> seeds{{0.5, 0, 0}};
  const auto refused = [&](const auto& change) {
    TraceOptions options;
    change(options);
    EXPECT_THROW((void)trace_lines(*boxes, seeds, options), Error);
  };
  refused([](TraceOptions& o) { o.integrator = Integrator::kExact; });
  refused([](TraceOptions& o) { o.forward = false; });
  refused([](TraceOptions& o) { o.tolerance = 0.0; });
  refused([](TraceOptions& o) { o.tolerance = NAN; });
  refused([](TraceOptions& o) { o.step = -1.0; });
  refused([](TraceOptions& o) { o.max_steps = 0; });
  EXPECT_THROW((void)integrator_from_name("rk5"), Error);
  EXPECT_EQ(integrator_from_name("rodas4"), Integrator::kRodas4);
}

// A line that touches a grid edge: at x = 0, y = 1/4 the swirl turns back from the face y = 1/4 that it has
// just reached. Cell after cell predicted a crossing of no length, and the line was taken for standing still.
TEST(Ends, LineThatTouchesAFaceOnAnEdgeGoesOn) {
  constexpr int kPoints = 9;
  std::vector<double> values;
  for (int k = 0; k < kPoints; ++k) {
    for (int j = 0; j < kPoints; ++j) {
      for (int i = 0; i < kPoints; ++i) {
        const double x = -1.0 + 0.25 * i, y = -1.0 + 0.25 * j;
        values.insert(values.end(), {-y + 0.3, x, 0.4 + 0.1 * x * y});
      }
    }
  }
  DataSet block;
  block.topology = UniformTopology{.points = Index3{kPoints}, .origin = Vec3{-1.0}, .axes = Mat3{0.25}};
  block.arrays.push_back(make_array("velocity", Association::kPoint, 3, std::span<const double>(values)));
  const ArrayInfo info{"velocity", Association::kPoint, 3, ScalarType::kFloat64, values.size() / 3};
  const Field field = make_vector_field({block}, choose_vector({info}, "velocity", "swirl"), "swirl");
  const std::vector<Vec3> seeds{{-0.05, 0.3, -0.8}};
  for (const Integrator integrator : {Integrator::kRk4, Integrator::kDp54, Integrator::kRodas4}) {
    TraceOptions options;
    options.integrator = integrator;
    options.step = 0.000422864;
    const TraceResult result = trace_lines(*field, seeds, options);
    ASSERT_EQ(result.lines.size(), 1U);
    EXPECT_EQ(result.lines[0].end, End::kLeftDomain) << name_of(integrator);
  }
}

// Circles that touch faces of an even mesh on its edges: aims at a face that is only touched, to rounding,
// did not converge, and lines stopped there.
TEST(Ends, CirclesThatTouchFacesOnEdgesGoOn) {
  const Field field = test::on_tetrahedra(rows(0, -2, 0, 2, 0, 0, 0, 0, 0), Vec3{0.0}, 9, 0.0, 1);
  std::vector<Vec3> seeds;
  for (const double radius : {0.25, 0.5, 0.75}) {
    for (const double z : {0.0, 0.1, 0.125, 0.25, -0.3}) {
      for (const double angle : {0.0, 0.3}) {
        seeds.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
      }
    }
  }
  for (const Integrator integrator : {Integrator::kRk34, Integrator::kDp54, Integrator::kRodas4}) {
    for (const double tolerance : {1e-6, 1e-10}) {
      const TraceResult result = trace_lines(*field, seeds,
                                             {.integrator = integrator,
                                              .backward = true,
                                              .tolerance = tolerance,
                                              .max_length = 1.4,
                                              .max_steps = 100'000,
                                              .threads = 1});
      for (const Line& line : result.lines) {
        const Vec3& x = line.points.back().position;
        // The smallest circles close before their length is reached.
        EXPECT_TRUE(line.end == End::kMaxLength || line.end == End::kLoop)
            << name_of(integrator) << " " << tolerance << " stops at " << x.x << " " << x.y << " " << x.z
            << ": " << name_of(line.end);
      }
    }
  }
}

}  // namespace
}  // namespace palpate
