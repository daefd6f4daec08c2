// Lines of linear fields over random tetrahedra against the matrix exponential. The interpolant is the linear
// field itself (see linear_fields.h), so what differs is the tracer's own error.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "common/trace/trace.h"
#include "tests/common/trace/linear_fields.h"

namespace palpate {
namespace {

using test::rows;

constexpr double kDiagonal = 2.0 * std::numbers::sqrt3;
constexpr double kAllowed = 1e-9 * kDiagonal;  // what the contract promises of the default integrator

struct Flow {
  std::string name;
  Mat3 a;
  Vec3 c{0.0};
};

std::ostream& operator<<(std::ostream& out, const Flow& flow) { return out << flow.name; }

std::vector<Flow> flows() {
  return {
      {"rotation", rows(0, -2, 0, 2, 0, 0, 0, 0, 0), {0.125, 0.0625, 0}},
      {"helix", rows(0, -8, 0, 8, 0, 0, 0, 0, 1), {0.0625, 0, -1.5}},
      {"saddle", rows(1, 0, 0, 0, -2, 0, 0, 0, 1), {0.03125, 0.0625, 0.125}},
      {"source", rows(1, 0, 0, 0, 2, 0, 0, 0, 3), {0.0625, 0.03125, 0}},
      {"sink node", rows(-1, 1, 0, 0, -2, 1, 0, 0, -4), {0.0625, 0.03125, 0}},
      {"spiral sink", rows(-1, -8, 0, 8, -1, 0, 0, 0, -2), {0.0625, 0.03125, 0}},
      {"spiral source", rows(1, -8, 2, 8, 1, 0, 0, 1, 2), {0.0625, 0.03125, 0}},
      {"defective", rows(1, 1, 0, 0, 1, 1, 0, 0, 1), {0.0625, 0.03125, -0.25}},
      {"defective sink", rows(-1, 4, 0, 0, -1, 4, 0, 0, -1), {0.0625, 0.03125, -0.25}},
      {"nilpotent", rows(0, 1, 0, 0, 0, 1, 0, 0, 0), {0.0625, 0.03125, -1.25}},
      {"shear", rows(0, 3, 0, 0, 0, 0, 0, 0, 0), {0.0, 1.25, 0.0}},
      {"singular", rows(1, 2, 3, 2, 4, 6, 3, 6, 9), {0.0625, 0.03125, -0.25}},
      {"singular sink", rows(-1, 0, 0, 0, -2, 0, 0, 0, 0), {0.0625, 0.03125, 0.0}},
      // S diag(.) S^-1 with whole S of determinant 1: stiff, with exactly representable values.
      {"stiff 1e4", rows(-19999, 0, 19998, 0, -2, 0, -29997, 0, 29996), {1.25, 0.03125, 0.0}},
      {"stiff 1e8", rows(-268435456, 0, 0, 268435455, -1, 0, 0, 0, 1), {0.0625, 0.03125, 0.25}},
      {"stiff saddle", rows(-268435456, 0, 0, 0, 1, 0, 0, 0, 268435456), {0.0625, 0.03125, 0.25}},
      {"stiff rotation", rows(-1, -1048576, 0, 1048576, -1, 0, 0, 0, 4), {0.0625, 0.03125, -1.25}},
  };
}

/// Largest distance of the points of a line from the exact curve at the same times, along the curve allowed
/// for what the rounding of the time itself moves (|v| eps t).
double error_of(const Line& line, const Flow& flow, const Vec3& seed, double sign) {
  double worst = 0.0;
  for (const LinePoint& p : line.points) {
    const double clock = p.speed * std::abs(p.time) * 0x1p-50;
    worst = std::max(
        worst,
        glm::distance(p.position, test::exact_line(sign * flow.a, flow.c, seed, sign * p.time)) - clock);
  }
  return worst;
}

class ExactOnLinearFields : public testing::TestWithParam<Flow> {};

TEST_P(ExactOnLinearFields, FollowsTheMatrixExponential) {
  const Flow& flow = GetParam();
  for (const double flatten : {1.0, 1.0 / 64}) {
    const auto field = test::on_tetrahedra(flow.a, flow.c, 6, 0.3, 11, flatten);
    const std::vector<Vec3> seeds = test::random_seeds(20, 0.9, 5);
    TraceOptions options;
    options.backward = true;
    options.max_steps = 3000;
    options.threads = 1;
    const TraceResult result = trace_lines(*field, seeds, options);
    EXPECT_EQ(result.integrator, Integrator::kExact);
    ASSERT_EQ(result.lines.size(), 40u);
    for (const Line& line : result.lines) {
      const double sign = line.direction == TraceDirection::kForward ? 1.0 : -1.0;
      const double error = error_of(line, flow, seeds[line.seed], 1.0);
      EXPECT_LE(error, kAllowed) << flow.name << " seed " << line.seed << " sign " << sign << " flatten "
                                 << flatten << " points " << line.points.size() << " end "
                                 << name_of(line.end);
      for (const LinePoint& p : line.points) {
        ASSERT_TRUE(is_finite(p.position) && std::isfinite(p.time) && std::isfinite(p.arc) && p.error > 0.0);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, ExactOnLinearFields, testing::ValuesIn(flows()), [](const auto& flow) {
  std::string name = flow.param.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

}  // namespace
}  // namespace palpate
