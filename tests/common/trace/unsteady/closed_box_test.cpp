// Boxes whose walls let nothing through: the normal velocity vanishes there, and no line leaves, whatever rounding does to it.

#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/trace/trace.h"
#include "common/trace/unsteady/trace_unsteady.h"
#include "tests/common/trace/unsteady/flows_in_time.h"
#include "tests/support/samples.h"

namespace palpate {
namespace {

using test::at_moment;
using test::Grid;

std::string what_of(Grid grid, TimeOrder order) {
  return std::to_string(static_cast<int>(grid)) + " " + std::string(name_of(order));
}

/// v = ((20 + 20 t)(1 - x), 0.2 - 0.2 t, 0): linear in space and in time, so that every grid has it exactly. A particle comes as
/// near to the wall x = 1 as e^-80 and slides along it.
Vec3 towards_wall(double t, const Vec3& x) { return {(20.0 + 20.0 * t) * (1.0 - x.x), 0.2 - 0.2 * t, 0.0}; }
Vec3 slid(const Vec3& x, double t) {
  const double way = 20.0 * t + 10.0 * t * t;
  return {1.0 - (1.0 - x.x) * std::exp(-way), x.y + 0.2 * t - 0.1 * t * t, x.z};
}

TEST(ClosedBox, PathlinesStayAtAWallThatTheyComeNearTo) {
  const std::vector<double> times = test::steps_until(2.0, 8);
  const std::vector<Vec3> seeds{
      {0.5, 0.1, 0.2}, {-0.9, -0.4, -0.7}, {0.99, 0.3, 0.9}, {1.0, 0.2, 0.1}, {0.3, 0.7, 1.0}};
  for (const Grid grid : test::kGrids) {
    for (const TimeOrder order : {TimeOrder::kLinear, TimeOrder::kCubic}) {
      const auto read = [&](std::size_t step) {
        return at_moment(grid, [t = times[step]](const Vec3& x) { return towards_wall(t, x); });
      };
      const UnsteadyResult result = trace_unsteady(times, read, seeds, {.order = order, .trace = {}});
      EXPECT_EQ(result.trace.lines.size(), seeds.size()) << what_of(grid, order);
      for (const Line& line : result.trace.lines) {
        EXPECT_EQ(name_of(line.end), name_of(End::kEndOfTime))
            << what_of(grid, order) << " seed " << line.seed;
        for (const LinePoint& point : line.points) {
          EXPECT_LE(glm::distance(point.position, slid(seeds[line.seed], point.time)),
                    1.1 * point.error + 1e-9)
              << what_of(grid, order) << " seed " << line.seed << " at " << point.time;
        }
      }
    }
  }
}

/// A vortex that swings, in a box that it fills to its edges: (-(1 - x^2) y, x (1 - y^2), 0.3 (1 - z^2) sin 3t).
Vec3 vortex(double t, const Vec3& x) {
  const double rate = 1.0 + 0.8 * std::cos(2.0 * t);
  return {-rate * (1.0 - x.x * x.x) * x.y, rate * x.x * (1.0 - x.y * x.y),
          0.3 * (1.0 - x.z * x.z) * std::sin(3.0 * t)};
}

/// Walls that are still: as (1 - x^2)(1 - y^2)(1 - z^2), in any direction.
Vec3 still_at_walls(double t, const Vec3& x) {
  const double inside = (1.0 - x.x * x.x) * (1.0 - x.y * x.y) * (1.0 - x.z * x.z);
  return inside * Vec3{std::cos(t) + x.y, std::sin(0.7 * t) - x.x, 0.6 * std::cos(1.3 * t)};
}

using FlowAt = Vec3 (*)(double, const Vec3&);

/// Anywhere, near walls, and on them.
std::vector<Vec3> seeds_of_box(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::vector<Vec3> seeds;
  for (int i = 0; i < count; ++i) {
    Vec3 x{any(random), any(random), any(random)};
    const int axis = i % 3;
    if (i % 4 == 1) x[axis] = 1.0 - 1e-3 * std::abs(any(random));
    if (i % 4 == 2) x[axis] = -1.0 + 1e-9;
    if (i % 4 == 3) x[axis] = 1.0;
    seeds.push_back(x);
  }
  return seeds;
}

class ClosedBoxOf : public ::testing::TestWithParam<FlowAt> {};
INSTANTIATE_TEST_SUITE_P(Slip, ClosedBoxOf, ::testing::Values(&vortex));
INSTANTIATE_TEST_SUITE_P(Still, ClosedBoxOf, ::testing::Values(&still_at_walls));

TEST_P(ClosedBoxOf, LetsNoPathlineOut) {
  const std::vector<double> times = test::steps_until(12.0, 120);
  const std::vector<Vec3> seeds = seeds_of_box(test::samples_of(40));
  for (const Grid grid : test::kGrids) {
    const auto read = [&](std::size_t step) {
      return at_moment(grid, [t = times[step]](const Vec3& x) { return GetParam()(t, x); });
    };
    UnsteadyOptions options;
    options.trace.max_length = 1e3;
    options.trace.threads = 2;
    const UnsteadyResult result = trace_unsteady(times, read, seeds, options);
    for (const Line& line : result.trace.lines) {
      const Vec3 last = line.points.back().position;
      EXPECT_NE(name_of(line.end), name_of(End::kLeftDomain))
          << static_cast<int>(grid) << " seed " << line.seed << " at " << last.x << " " << last.y << " "
          << last.z;
    }
  }
}

// Where walls are still. Along others rounding may take a line out in time (docs/limits.md).
TEST(ClosedBox, StreamlinesEndAtStillWalls) {
  const std::vector<Vec3> seeds = seeds_of_box(test::samples_of(40));
  for (const Grid grid : test::kGrids) {
    const auto field = at_moment(grid, [](const Vec3& x) { return still_at_walls(0.3, x); });
    for (const Integrator integrator : {default_integrator(*field), Integrator::kDp54, Integrator::kBs32}) {
      TraceOptions options;
      options.integrator = integrator;
      options.max_length = 60.0;
      options.threads = 2;
      for (const Line& line : trace_lines(*field, seeds, options).lines) {
        const Vec3 last = line.points.back().position;
        EXPECT_NE(name_of(line.end), name_of(End::kLeftDomain))
            << static_cast<int>(grid) << " " << name_of(integrator) << " seed " << line.seed << " at "
            << last.x << " " << last.y << " " << last.z;
      }
    }
  }
}

}  // namespace
}  // namespace palpate
