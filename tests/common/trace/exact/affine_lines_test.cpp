// Lines of affine fields, however stiff, on meshes of every kind against their closed form.

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/trace/trace.h"
#include "lab/extremes/affine_field.h"
#include "tests/support/samples.h"

namespace palpate::test {
namespace {

class ExactOnAffineFields : public testing::TestWithParam<int> {};

// Rates up to 2^exponent: points lie on the curve within the error that they state, which says no more than it has to, and
// lines end where the curve ends.
TEST_P(ExactOnAffineFields, StatesItsErrorAndEndsWhereTheCurveEnds) {
  constexpr int kFields = samples_of(60), kSeeds = 10, kSteps = 500;  // some 10^4 lines over all rates
  const int exponent = GetParam();
  std::size_t points = 0, understated = 0, bad = 0, lines = 0;
  std::vector<float> overstated;
  for (std::uint64_t n = 0; n < kFields; ++n) {
    std::mt19937_64 random{static_cast<std::uint64_t>(1000 * exponent) + n};
    AffineField field;
    AffineMesh mesh;
    std::shared_ptr<const VectorField> flow;
    while (!flow) {
      field = draw_field(random, exponent);
      mesh = draw_mesh(random);
      flow = sampled(field, mesh);
    }
    std::vector<Vec3> seeds;
    for (int i = 0; i < kSeeds; ++i) seeds.push_back(draw_seed(random, mesh));
    TraceOptions options;
    options.backward = true;
    options.max_steps = kSteps;
    options.threads = 1;
    const TraceResult result = trace_lines(*flow, seeds, options);
    for (const Line& line : result.lines) {
      const LineVerdict verdict = judge(line, field, mesh, seeds[line.seed], flow->diagonal());
      ++lines;
      points += verdict.points;
      understated += verdict.understated;
      bad += verdict.wrong_end.empty() ? 0u : 1u;
      overstated.insert(overstated.end(), verdict.overstated.begin(), verdict.overstated.end());
    }
  }
  EXPECT_LE(understated, points / 1000);
  // Beyond this a slow rate beside the fastest one is the last digits of the values.
  EXPECT_LE(bad, exponent <= 40 ? 0u : lines / 400);
  std::nth_element(overstated.begin(),
                   overstated.begin() + static_cast<std::ptrdiff_t>(overstated.size() / 2), overstated.end());
  EXPECT_LE(overstated[overstated.size() / 2], 1250.0f);
}

INSTANTIATE_TEST_SUITE_P(Rates, ExactOnAffineFields, testing::Values(0, 4, 10, 20, 30, 40, 47, 54, 60));

/// A field of exact_lines_bench, by its number there, and its lines.
struct BenchField {
  AffineField field;
  AffineMesh mesh;
  std::vector<Vec3> seeds;
  TraceResult result;
  double diagonal = 0.0;

  explicit BenchField(unsigned number) {
    std::mt19937_64 random{number};
    const int exponent = static_cast<int>(random() % 61);
    std::shared_ptr<const VectorField> flow;
    while (!flow) {
      field = draw_field(random, exponent);
      mesh = draw_mesh(random);
      flow = sampled(field, mesh);
    }
    for (int i = 0; i < 20; ++i) seeds.push_back(draw_seed(random, mesh));
    TraceOptions options;
    options.backward = true;
    options.max_steps = 1000;
    options.threads = 1;
    result = trace_lines(*flow, seeds, options);
    diagonal = flow->diagonal();
  }
};

// Lines of the first five were off by up to 3900 times what they state: errors of later cells were counted along the flow,
// where they cost nothing. Errors of the last one grow beyond all numbers.
TEST(ExactLines, StateWhatLaterCellsAddAcrossTheFlow) {
  for (const unsigned number : {17623U, 11649U, 19473U, 18578U, 24449U, 4000876U}) {
    const BenchField bench(number);
    for (const Line& line : bench.result.lines) {
      const LineVerdict verdict =
          judge(line, bench.field, bench.mesh, bench.seeds[line.seed], bench.diagonal);
      EXPECT_LE(verdict.worst_excess, 10.0) << number << " " << line.seed;
      EXPECT_EQ(verdict.wrong_end, "") << number << " " << line.seed;
    }
  }
}

// At 1.5 times what the values can tell from rest a line creeps for 1e14 units of time: it was off by 20 times what it stated.
TEST(ExactLines, StateWhatValuesLeaveOpenOfSlowSpeeds) {
  const BenchField bench(50071988U);
  for (const Line& line : bench.result.lines) {
    const LineVerdict verdict = judge(line, bench.field, bench.mesh, bench.seeds[line.seed], bench.diagonal);
    EXPECT_LE(verdict.worst_excess, 2.0) << line.seed;
  }
}

// In slivers the modes of a cell are so oblique that their terms are hundreds of times their sum, and leave that much more open.
TEST(ExactLines, StateWhatTermsLargerThanTheirSumLeaveOpen) {
  const BenchField bench(3003335U);
  for (const Line& line : bench.result.lines) {
    const LineVerdict verdict = judge(line, bench.field, bench.mesh, bench.seeds[line.seed], bench.diagonal);
    EXPECT_EQ(verdict.understated, 0U) << line.seed << ": " << verdict.worst_excess;
  }
}

// A speed of 0.05 beside one of 2.6e13: in a cell of slivers doubles take it for rest.
TEST(ExactLines, GoOnAlongASlowManifoldThatDoublesTakeForRest) {
  const BenchField bench(12642U);
  int left = 0;
  for (const Line& line : bench.result.lines) {
    if (line.direction != TraceDirection::kForward) continue;
    if (line.seed != 3 && line.seed != 12 && line.seed != 18) continue;
    EXPECT_EQ(line.end, End::kLeftDomain) << line.seed;
    ++left;
  }
  EXPECT_EQ(left, 3);
}

// A spiral dies out, and the line creeps out of its cell along the axis: after as many turns as the rates are apart.
TEST(ExactLines, LeaveSlowlyOnceASpiralHasDiedOut) {
  for (const int exponent : {2, 12, 30, 44}) {
    const Long fast = std::ldexp(1.0L, exponent);
    std::mt19937_64 random{static_cast<std::uint64_t>(exponent)};
    for (int n = 0; n < 6; ++n) {
      const AffineMesh mesh = draw_mesh(random);
      AffineField field;
      field.name = "spiral";
      field.a = {{{0.5L, 0, 0}, {0, 0, -fast}, {0, 0.5L * fast, -fast}}};
      field.frame = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
      field.form = {.rate = 0.5L, .a = 0, .b = -fast, .c = 0.5L * fast, .d = -fast};
      field.center = {1.1875, -0.4375, 0.40625};
      const auto flow = sampled(field, mesh);
      ASSERT_NE(flow, nullptr);
      std::vector<Vec3> seeds;
      for (int i = 0; i < 10; ++i) seeds.push_back(draw_seed(random, mesh));
      TraceOptions options;
      options.threads = 1;
      for (const Line& line : trace_lines(*flow, seeds, options).lines) {
        const LineVerdict verdict = judge(line, field, mesh, seeds[line.seed], flow->diagonal());
        EXPECT_EQ(verdict.wrong_end, "") << exponent << " " << mesh.name << " " << line.seed;
        EXPECT_EQ(line.end, End::kLeftDomain) << exponent << " " << mesh.name << " " << line.seed;
      }
    }
  }
}

// Cells that a file has twice, as pieces with a layer in common: lines are those of the mesh without them, and end at its border.
TEST(ExactLines, PassThroughCellsThatAreThereTwice) {
  std::mt19937_64 random{7};
  AffineField field;
  field.name = "helix";
  field.a = {{{0, -1, 0}, {1, 0, 0}, {0, 0, 0.25L}}};
  field.frame = {{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}};
  field.form = {.rate = 0.25L, .a = 0, .b = -1, .c = 1, .d = 0};
  field.center = {0.25, -0.375, -2.0};
  for (const Integrator method : {Integrator::kExact, Integrator::kDp54}) {
    for (int n = 0; n < 6; ++n) {
      AffineMesh mesh = draw_mesh(random);
      const std::size_t half = mesh.cells.size() / 2;
      mesh.cells.insert(mesh.cells.end(), mesh.cells.begin(),
                        mesh.cells.begin() + static_cast<std::ptrdiff_t>(half));
      const auto flow = sampled(field, mesh);
      ASSERT_NE(flow, nullptr);
      std::vector<Vec3> seeds;
      for (int i = 0; i < 10; ++i) seeds.push_back(draw_seed(random, mesh));
      TraceOptions options{.integrator = method, .tolerance = 1e-9};
      options.backward = true;
      options.threads = 1;
      options.max_steps = 20000;
      for (const Line& line : trace_lines(*flow, seeds, options).lines) {
        const LineVerdict verdict = judge(line, field, mesh, seeds[line.seed], flow->diagonal());
        EXPECT_EQ(line.end, End::kLeftDomain) << mesh.name << " " << line.seed;
        EXPECT_EQ(verdict.wrong_end, "") << mesh.name << " " << line.seed;
        EXPECT_LE(verdict.worst_error, method == Integrator::kExact ? 1e-12 : 1e-7) << mesh.name;
      }
    }
  }
}

// A solid block in the flow, whose speed is the rounding of what computed it: lines rest at it, as far as its values tell.
TEST(ExactLines, EndWhereValuesCannotTellTheSpeedFromZero) {
  std::mt19937_64 random{1};
  AffineMesh mesh;
  while (mesh.name != "dyadic, six") mesh = draw_mesh(random);
  constexpr double kBlock = 0.25;
  std::vector<float> values;
  for (const Vec3& x : mesh.points) {
    const float speed = x.x < kBlock ? 1.0f : 3e-14f;
    values.insert(values.end(), {speed, 0.1f * speed, -0.05f * speed});
  }
  const auto field = on_mesh(mesh, values);
  TraceOptions options;
  options.threads = 1;
  const std::vector<Vec3> seeds{{-0.75, 0.125, 0.0625}, {-0.5, -0.375, 0.25}, {0.0, 0.0, 0.0}};
  for (const Line& line : trace_lines(*field, seeds, options).lines) {
    EXPECT_EQ(line.end, End::kStagnation);
    EXPECT_NEAR(line.points.back().position.x, kBlock, 1e-5);
  }
}

}  // namespace
}  // namespace palpate::test
