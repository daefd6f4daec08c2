// Lines of flows in time against closed forms: on every kind of grid, in both directions. Grids that move: moving_grids_test.cpp.

#include "common/trace/unsteady/trace_unsteady.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/common/trace/unsteady/flows_in_time.h"

namespace palpate {
namespace {

using test::Grid;
using test::SwingingTurn;

const std::vector<Vec3> kSeeds{{0.5, 0.1, 0.2}, {-0.3, 0.6, -0.4}, {0.05, -0.05, 0.0}};

double worst_error(const UnsteadyResult& result, const std::vector<Vec3>& seeds, double sign = 1.0) {
  double worst = 0.0;
  for (const Line& line : result.trace.lines) {
    for (const LinePoint& point : line.points) {
      EXPECT_GE(sign * point.time, 0.0);
      const Vec3 there = SwingingTurn::carried(seeds[line.seed], line.moment, line.moment + point.time);
      worst = std::max(worst, glm::distance(point.position, there));
    }
  }
  return worst;
}

TEST(Pathlines, ThatTakeMoreMemoryThanTheyMayAreRefused) {
  const std::vector<double> times = test::steps_until(2.0, 24);
  UnsteadyOptions options{.order = TimeOrder::kLinear, .trace = {}};
  options.trace.memory = 4096;
  const StepReader read = test::swinging(test::kGrids[0], times);
  try {
    (void)trace_unsteady(times, read, kSeeds, options);
    ADD_FAILURE() << "nothing was said";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("--memory"), std::string::npos) << error.what();
  }
  options.trace.memory = std::uint64_t{1} << 30;
  EXPECT_EQ(trace_unsteady(times, read, kSeeds, options).trace.lines.size(), kSeeds.size());
}

TEST(Pathlines, FollowAClosedFormOnEveryGridWithinTheirError) {
  const std::vector<double> times = test::steps_until(2.0, 24);
  for (const Grid grid : test::kGrids) {
    for (const TimeOrder order : {TimeOrder::kLinear, TimeOrder::kCubic}) {
      const UnsteadyResult result =
          trace_unsteady(times, test::swinging(grid, times), kSeeds, {.order = order, .trace = {}});
      const std::string what = std::to_string(static_cast<int>(grid)) + " " + std::string(name_of(order));
      ASSERT_EQ(result.trace.lines.size(), kSeeds.size()) << what;
      EXPECT_EQ(result.trace.ends[as_size(End::kEndOfTime)], kSeeds.size()) << what;
      EXPECT_TRUE(result.in_time.sampling_known);
      EXPECT_EQ(result.in_time.steps_in_memory, order == TimeOrder::kLinear ? 2U : 4U);
      double stated = 0.0;
      for (const Line& line : result.trace.lines) {
        EXPECT_DOUBLE_EQ(line.points.back().time, 2.0) << what;
        for (const LinePoint& point : line.points) {
          const double off =
              glm::distance(point.position, SwingingTurn::carried(kSeeds[line.seed], 0.0, point.time));
          // Up to ten per cent: the distance that is measured at every second step lies between two of them.
          EXPECT_LE(off, 1.1 * point.error + 1e-9) << what << " at " << point.time;
          stated = std::max(stated, point.error);
        }
      }
      const double worst = worst_error(result, kSeeds);
      EXPECT_LT(worst, order == TimeOrder::kLinear ? 5e-3 : 5e-4) << what;
      EXPECT_LT(stated, 40.0 * worst + 1e-5) << what;  // it says no more than it must
    }
  }
}

/// Slabs of one velocity each, a quarter wide: cells with values of their own.
Vec3 in_slab(double x) {
  const bool odd = std::fmod(std::floor(4.0 * (x + 1.0)), 2.0) != 0.0;
  return odd ? Vec3(1.5, -0.4, 0.1) : Vec3(0.5, 0.7, -0.3);
}

class Slabs final : public AnalyticField {
 public:
  [[nodiscard]] Vec3 velocity(const Vec3& x) const noexcept override { return in_slab(x.x); }
  [[nodiscard]] Mat3 jacobian(const Vec3&) const noexcept override { return Mat3{0.0}; }
  [[nodiscard]] Box bounds() const noexcept override { return {Vec3{-1.0}, Vec3{1.0}}; }
  [[nodiscard]] std::string name() const override { return "slabs"; }
  [[nodiscard]] std::string description() const override { return "slabs"; }
};

/// Where a particle is after t, slab by slab.
Vec3 through_slabs(Vec3 x, double t) {
  while (t > 0.0) {
    const double border = 0.25 * (std::floor(4.0 * (x.x + 1.0)) + 1.0) - 1.0;
    const Vec3 v = in_slab(x.x);
    const double step = std::min(t, (border - x.x) / v.x);
    x += step * v;
    t -= step;
    if (t > 0.0) x.x = border;
  }
  return x;
}

TEST(Pathlines, CrossJumpsOfTheVelocity) {
  const std::vector<double> times = test::steps_until(4.0, 4);
  const StepReader read = [](std::size_t) { return make_vector_field(std::make_shared<Slabs>()); };
  const std::vector<Vec3> seeds{{-0.9, -0.5, 0.1}, {-0.75, -0.3, 0.2}, {-0.01, 0.0, 0.0}};
  for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
    UnsteadyOptions options;
    options.trace.tolerance = tolerance;
    const UnsteadyResult result = trace_unsteady(times, read, seeds, options);
    ASSERT_EQ(result.trace.lines.size(), seeds.size());
    EXPECT_EQ(result.trace.ends[as_size(End::kLeftDomain)], seeds.size()) << tolerance;
    for (const Line& line : result.trace.lines) {
      EXPECT_LT(line.points.size(), 2000U);
      for (const LinePoint& point : line.points) {
        const double off = glm::distance(point.position, through_slabs(seeds[line.seed], point.time));
        EXPECT_LE(off, 2.0 * point.error + 1e-13) << tolerance << " at " << point.time;
      }
      EXPECT_NEAR(line.points.back().position.x, 1.0, 4.0 * tolerance);
      EXPECT_LT(line.points.back().error, 100.0 * tolerance);
    }
  }
}

TEST(UnsteadyLines, TakeTimesThatDifferByRoundingForOne) {
  std::vector<double> times{0.0};
  for (int i = 0; i < 10; ++i) times.push_back(times.back() + 0.1);
  ASSERT_LT(times.back(), 1.0);
  const UnsteadyResult result =
      trace_unsteady(times, test::swinging(Grid::kFormula, times), kSeeds, {.until = 1.0, .trace = {}});
  EXPECT_EQ(result.trace.ends[as_size(End::kEndOfTime)], kSeeds.size());
  EXPECT_THROW((void)trace_unsteady(times, test::swinging(Grid::kFormula, times), kSeeds,
                                    {.until = 1.0 + 1e-9, .trace = {}}),
               Error);
}

// From rest: v = 20 t (-y, x, 0) between two steps turns a particle by 10 t^2.
TEST(Pathlines, StartAtRestAndFollowAFlowThatSetsIn) {
  const std::vector<double> times{0.0, 1.0};
  for (const Grid grid : test::kGrids) {
    const StepReader reader = [&](std::size_t step) {
      const double rate = step == 0 ? 0.0 : 20.0;
      return test::at_moment(grid, [rate](const Vec3& x) { return Vec3{-rate * x.y, rate * x.x, 0.0}; });
    };
    const UnsteadyResult result =
        trace_unsteady(times, reader, kSeeds, {.order = TimeOrder::kLinear, .trace = {}});
    const std::string what = std::to_string(static_cast<int>(grid));
    ASSERT_EQ(result.trace.lines.size(), kSeeds.size()) << what;
    EXPECT_EQ(result.trace.ends[as_size(End::kEndOfTime)], kSeeds.size()) << what;
    for (const Line& line : result.trace.lines) {
      const Vec3& seed = kSeeds[line.seed];
      EXPECT_DOUBLE_EQ(line.points.back().time, 1.0) << what;
      for (const LinePoint& point : line.points) {
        const double angle = 10.0 * point.time * point.time;
        const double c = std::cos(angle), s = std::sin(angle);
        const Vec3 there{c * seed.x - s * seed.y, s * seed.x + c * seed.y, seed.z};
        EXPECT_LT(glm::distance(point.position, there), 1e-4) << what << " at " << point.time;
      }
    }
  }
}

TEST(Pathlines, ErrorFallsWithTheOrderOfTheInterpolationInTime) {
  for (const TimeOrder order : {TimeOrder::kLinear, TimeOrder::kCubic}) {
    std::vector<double> errors;
    for (const int intervals : {16, 32, 64}) {
      const std::vector<double> times = test::steps_until(2.0, intervals);
      UnsteadyOptions options{.order = order, .trace = {}};
      options.trace.tolerance = 1e-9;
      errors.push_back(
          worst_error(trace_unsteady(times, test::swinging(Grid::kFormula, times), kSeeds, options), kSeeds));
    }
    for (std::size_t i = 0; i + 1 < errors.size(); ++i) {
      const double rate = std::log2(errors[i] / errors[i + 1]);
      if (order == TimeOrder::kLinear) {
        EXPECT_NEAR(rate, 2.0, 0.2) << errors[i];
      } else {
        EXPECT_GT(rate, 2.8) << errors[i];
      }
    }
  }
}

TEST(Pathlines, GoBackToWhereTheyCameFrom) {
  const std::vector<double> times = test::steps_until(2.0, 40);
  UnsteadyOptions options{.order = TimeOrder::kCubic, .from = 1.7, .until = 0.3, .trace = {}};
  options.trace.forward = false;
  options.trace.backward = true;
  const UnsteadyResult result =
      trace_unsteady(times, test::swinging(Grid::kTetrahedra, times), kSeeds, options);
  ASSERT_EQ(result.trace.lines.size(), kSeeds.size());
  for (const Line& line : result.trace.lines) {
    EXPECT_EQ(line.direction, TraceDirection::kBackward);
    EXPECT_NEAR(line.points.back().time, -1.4, 1e-12);
    EXPECT_EQ(line.moment, 1.7);
  }
  EXPECT_LT(worst_error(result, kSeeds, -1.0), 2e-4);
}

TEST(Pathlines, AreReleasedAgainAndAgain) {
  const std::vector<double> times = test::steps_until(2.0, 20);
  const UnsteadyResult result = trace_unsteady(times, test::swinging(Grid::kUniform, times), kSeeds,
                                               {.from = 0.25, .every = 0.5, .trace = {}});
  ASSERT_EQ(result.trace.lines.size(), 4 * kSeeds.size());  // 0.25, 0.75, 1.25, 1.75
  for (std::size_t l = 0; l < result.trace.lines.size(); ++l) {
    EXPECT_DOUBLE_EQ(result.trace.lines[l].moment, 0.25 + 0.5 * static_cast<double>(l % 4));
    EXPECT_EQ(result.trace.lines[l].seed, l / 4);
  }
  EXPECT_LT(worst_error(result, kSeeds), 1e-2);
}

TEST(Streaklines, JoinWhatOneSeedReleased) {
  const std::vector<double> times = test::steps_until(2.0, 40);
  const UnsteadyResult result = trace_unsteady(
      times, test::swinging(Grid::kTetrahedra, times), kSeeds,
      {.kind = LineKind::kStreaklines, .order = TimeOrder::kCubic, .until = 1.5, .every = 0.05, .trace = {}});
  ASSERT_EQ(result.trace.lines.size(), kSeeds.size());
  for (const Line& line : result.trace.lines) {
    ASSERT_EQ(line.points.size(), 31U);
    EXPECT_EQ(line.moment, 1.5);
    EXPECT_EQ(line.points.front().position, kSeeds[line.seed]);  // just released
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      const LinePoint& point = line.points[i];
      EXPECT_NEAR(point.time, 0.05 * static_cast<double>(i), 1e-12);
      const Vec3 there = SwingingTurn::carried(kSeeds[line.seed], 1.5 - point.time, 1.5);
      EXPECT_LT(glm::distance(point.position, there), 1e-4 + 1.1 * point.error);
    }
  }
}

TEST(Timelines, JoinWhatLayOnOneLine) {
  const std::vector<double> times = test::steps_until(2.0, 40);
  std::vector<Vec3> row;
  for (int i = 0; i <= 20; ++i) row.emplace_back(0.03 * i, 0.0, 0.1);
  const UnsteadyResult result =
      trace_unsteady(times, test::swinging(Grid::kRectilinear, times), row,
                     {.kind = LineKind::kTimelines, .order = TimeOrder::kCubic, .every = 1.0, .trace = {}});
  ASSERT_EQ(result.trace.lines.size(), 2U);
  for (std::size_t l = 0; l < 2; ++l) {
    const Line& line = result.trace.lines[l];
    ASSERT_EQ(line.points.size(), row.size());
    for (std::size_t i = 0; i < row.size(); ++i) {
      const Vec3 there = SwingingTurn::carried(row[i], static_cast<double>(l), 2.0);
      EXPECT_LT(glm::distance(line.points[i].position, there), 2e-4);
    }
    EXPECT_NEAR(line.points.back().arc, 0.6, 1e-3);  // a rigid motion
  }
}

TEST(Pathlines, EndWhereTheFlowEnds) {
  const std::vector<double> times = test::steps_until(4.0, 8);
  for (const Grid grid : test::kGrids) {
    const auto read = [&](std::size_t step) {
      return test::at_moment(grid, [t = times[step]](const Vec3&) { return Vec3{0.5 * t, 0.1, 0.0}; });
    };
    // x = t^2 / 4, since the flow is linear in time: the wall is met at t = 2.
    const UnsteadyResult result =
        trace_unsteady(times, read, std::vector<Vec3>{{0.0, 0.0, 0.0}}, {.trace = {}});
    ASSERT_EQ(result.trace.lines.size(), 1U);
    const Line& line = result.trace.lines.front();
    EXPECT_EQ(line.end, End::kLeftDomain);
    EXPECT_NEAR(line.points.back().time, 2.0, 1e-4);
    EXPECT_NEAR(line.points.back().position.x, 1.0, 1e-4);
    EXPECT_LE(line.points.back().position.x, 1.0 + 1e-9);
  }
}

TEST(Streaklines, AreCutWhereParticlesHaveLeft) {
  const std::vector<double> times = test::steps_until(4.0, 8);
  // To and fro: particles that were released early have left on the right before the flow turns.
  const auto read = [&](std::size_t step) {
    return test::at_moment(Grid::kUniform, [t = times[step]](const Vec3&) {
      return Vec3{1.0 - 0.4 * t, 0.0, 0.1};
    });
  };
  const UnsteadyResult result = trace_unsteady(times, read, std::vector<Vec3>{{0.0, 0.0, 0.0}},
                                               {.kind = LineKind::kStreaklines, .every = 0.25, .trace = {}});
  ASSERT_FALSE(result.trace.lines.empty());
  EXPECT_EQ(result.trace.lines.front().end, End::kLeftDomain);
  EXPECT_EQ(result.in_time.torn, 1U);
  std::size_t points = 0;
  for (const Line& line : result.trace.lines) points += line.points.size();
  EXPECT_LT(points, 17U);
}

TEST(Pathlines, HaveLimitsAndEndsLikeStreamlines) {
  const std::vector<double> times = test::steps_until(2.0, 10);
  const StepReader read = test::swinging(Grid::kTetrahedra, times);
  const std::vector<Vec3> seed{{0.5, 0.0, 0.0}};
  const auto end_with = [&](const TraceOptions& trace) {
    const UnsteadyResult result = trace_unsteady(times, read, seed, {.trace = trace});
    return result.trace.lines.front();
  };
  const Line length = end_with({.max_length = 0.3});
  EXPECT_EQ(length.end, End::kMaxLength);
  EXPECT_NEAR(length.points.back().arc, 0.3, 1e-6);
  const Line time = end_with({.max_time = 0.7});
  EXPECT_EQ(time.end, End::kMaxTime);
  EXPECT_NEAR(time.points.back().time, 0.7, 1e-9);
  EXPECT_EQ(end_with({.max_steps = 5}).end, End::kMaxSteps);
  const Line plane = end_with({.stop_rules = {{[](const Vec3& x) { return x.y - 0.25; }}}});
  EXPECT_EQ(plane.end, End::kStoppedByRule);
  EXPECT_NEAR(plane.points.back().position.y, 0.25, 1e-6);
}

TEST(Pathlines, EndAtBadData) {
  const std::vector<double> times = test::steps_until(4.0, 8);
  for (const Grid grid : {Grid::kUniform, Grid::kTetrahedra}) {
    const auto read = [&](std::size_t step) {
      return test::at_moment(grid, [last = step >= 4](const Vec3& x) {
        return last && x.x > 0.3 ? Vec3{NAN} : Vec3{0.2, 0.0, 0.0};
      });
    };
    const UnsteadyResult result =
        trace_unsteady(times, read, std::vector<Vec3>{{0.0, 0.1, 0.1}}, {.trace = {}});
    EXPECT_EQ(result.trace.lines.front().end, End::kBadData);
    EXPECT_TRUE(std::isfinite(result.trace.lines.front().points.back().error));
  }
}

TEST(Pathlines, TakeOtherCellsWhereTheyLie) {
  const std::vector<double> times = test::steps_until(2.0, 40);
  const auto read = [&](std::size_t step) {
    const test::AtMoment formula([t = times[step]](const Vec3& x) { return SwingingTurn::velocity(t, x); });
    const int n = step % 2 == 0 ? 5 : 6;
    return test::field_of(
        test::sample_tetrahedra(formula, Index3{n}, 0.2, step, test::SampledType::kFloat64));
  };
  const UnsteadyResult result =
      trace_unsteady(times, read, kSeeds, {.order = TimeOrder::kCubic, .trace = {}});
  EXPECT_TRUE(result.in_time.other_meshes);
  EXPECT_LT(worst_error(result, kSeeds), 2e-4);
}

TEST(Pathlines, ScaleWithTheData) {
  // All lengths and speeds by a power of two: the same bits, scaled.
  const std::vector<double> times = test::steps_until(2.0, 10);
  const auto scaled = [&](double scale) {
    return [&times, scale](std::size_t step) {
      const test::AtMoment formula([](const Vec3&) { return Vec3{0.0}; });
      DataSet block = test::sample_tetrahedra(formula, Index3{4}, 0.2, 1, test::SampledType::kFloat64);
      auto& topology = std::get<UnstructuredTopology>(block.topology);
      std::vector<double> x, v;
      for (std::size_t p = 0; p < topology.positions.tuples; ++p) {
        const Vec3 at{topology.positions.at(p, 0), topology.positions.at(p, 1), topology.positions.at(p, 2)};
        const Vec3 flow = SwingingTurn::velocity(times[step], at);
        for (int i = 0; i < 3; ++i) {
          x.push_back(scale * at[i]);
          v.push_back(scale * flow[i]);
        }
      }
      topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(x));
      block.arrays = {make_array(test::kSampledName, Association::kPoint, 3, std::span<const double>(v))};
      return test::field_of(block);
    };
  };
  const auto one = trace_unsteady(times, scaled(1.0), kSeeds, {.trace = {}});
  for (const double scale : {0x1p-40, 0x1p120}) {
    std::vector<Vec3> seeds;
    for (const Vec3& x : kSeeds) seeds.push_back(scale * x);
    const auto other = trace_unsteady(times, scaled(scale), seeds, {.trace = {}});
    ASSERT_EQ(other.trace.points, one.trace.points);
    EXPECT_EQ(other.trace.lines[1].points.back().position, scale * one.trace.lines[1].points.back().position);
  }
}

TEST(Pathlines, DoNotDependOnTheNumberOfThreads) {
  const std::vector<double> times = test::steps_until(2.0, 10);
  const StepReader read = test::swinging(Grid::kTetrahedra, times);
  std::vector<UnsteadyResult> results;
  for (const int threads : {1, 3}) {
    TraceOptions trace;
    trace.threads = threads;
    results.push_back(trace_unsteady(times, read, kSeeds, {.every = 0.3, .trace = trace}));
  }
  ASSERT_EQ(results[0].trace.lines.size(), results[1].trace.lines.size());
  for (std::size_t l = 0; l < results[0].trace.lines.size(); ++l)
    EXPECT_EQ(results[0].trace.lines[l].points.back().position,
              results[1].trace.lines[l].points.back().position);
}

// Three intervals: without the second step the last would be as it was.
TEST(Pathlines, StateWhatTheLastOfAnOddNumberOfIntervalsCosts) {
  const std::vector<double> times{0.0, 0.9, 1.0, 1.9};
  const UnsteadyResult result =
      trace_unsteady(times, test::swinging(Grid::kUniform, times), kSeeds, {.trace = {}});
  double most = 0.0;
  for (const Line& line : result.trace.lines) {
    const LinePoint& last = line.points.back();
    const double off = glm::distance(last.position, SwingingTurn::carried(kSeeds[line.seed], 0.0, last.time));
    EXPECT_LE(off, last.error) << "seed " << line.seed;
    most = std::max(most, off);
  }
  EXPECT_GT(most, 1e-3) << "there is something to be stated";
}

TEST(Pathlines, OfTwoStepsDoNotKnowWhatTheSamplingCosts) {
  const std::vector<double> times{0.0, 1.0};
  const UnsteadyResult result =
      trace_unsteady(times, test::swinging(Grid::kUniform, times), kSeeds, {.trace = {}});
  EXPECT_FALSE(result.in_time.sampling_known);
}

TEST(UnsteadyLines, RefuseWhatMakesNoSense) {
  const std::vector<double> times = test::steps_until(1.0, 4);
  const StepReader read = test::swinging(Grid::kFormula, times);
  const auto refused = [&](const UnsteadyOptions& options, const std::string& why,
                           std::span<const double> at = {}) {
    try {
      (void)trace_unsteady(at.empty() ? times : at, read, kSeeds, options);
      ADD_FAILURE() << why;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  refused({.trace = {}}, "two steps", std::span(times).first(1));
  refused({.from = 2.0, .trace = {}}, "--release-from 2");
  refused({.from = 0.5, .until = 0.5, .trace = {}}, "no time");
  refused({.from = 0.5, .until = 7.0, .trace = {}}, "--until 7");
  refused({.trace = {.backward = true}}, "one way");
  refused({.kind = LineKind::kStreaklines, .from = 1.0, .trace = {.forward = false, .backward = true}},
          "streaklines");
  refused({.every = 1e-12, .trace = {}}, "releases");
  refused({.trace = {.integrator = Integrator::kRk4}}, "dp54");
}

}  // namespace
}  // namespace palpate
