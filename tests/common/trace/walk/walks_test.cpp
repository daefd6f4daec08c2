// Every integrator on every kind of field: order, tolerance, reversal, scaling, threads.

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/examples.h"
#include "common/trace/trace.h"
#include "tests/common/trace/linear_fields.h"
#include "tests/support/sampled.h"

namespace palpate {
namespace {

using Field = std::shared_ptr<const VectorField>;

constexpr Integrator kAdaptive[] = {Integrator::kBs32, Integrator::kRk34, Integrator::kDp54,
                                    Integrator::kRodas4};
constexpr Integrator kGeneral[] = {Integrator::kEuler, Integrator::kRk4,  Integrator::kBs32,
                                   Integrator::kRk34,  Integrator::kDp54, Integrator::kRodas4};

Field made(const DataSet& block) {
  std::vector<ArrayInfo> arrays;
  for (const DataArray& a : block.arrays)
    arrays.push_back({a.name, a.association, a.components, a.type, a.tuples});
  return make_vector_field({block}, choose_vector(arrays, "", "sampled"), "sampled");
}

Field formula() { return make_vector_field(example("abc")); }
Field boxes() { return made(test::sample_uniform(*example("abc"), Index3{17}, test::SampledType::kFloat64)); }
Field stretched() {
  return made(test::sample_rectilinear(*example("abc"), Index3{17}, 3.0, test::SampledType::kFloat64));
}
/// A left-handed lattice whose axes are off right angles by some 17 degrees.
Field sheared() {
  const auto flow = example("abc");
  const Index3 points{17};
  const Mat3 axes = Mat3{Vec3{-1.0, 0.1, 0.0}, Vec3{0.3, 1.0, 0.0}, Vec3{-0.2, 0.1, 1.0}} *
                    (flow->bounds().size().x / 16.0);
  const Vec3 origin = flow->bounds().center() - axes * (0.5 * Vec3(points - 1));
  std::vector<double> values;
  for (int k = 0; k < points.z; ++k) {
    for (int j = 0; j < points.y; ++j) {
      for (int i = 0; i < points.x; ++i) {
        const Vec3 v = flow->velocity(origin + axes * Vec3(i, j, k));
        values.insert(values.end(), {v.x, v.y, v.z});
      }
    }
  }
  DataSet block;
  block.topology = UniformTopology{points, origin, axes};
  block.arrays = {make_array("velocity", Association::kPoint, 3, std::span<const double>(values))};
  return made(block);
}
Field tets() {
  return made(test::sample_tetrahedra(*example("abc"), Index3{9}, 0.2, 3, test::SampledType::kFloat64));
}

struct Subject {
  std::string name;
  Field field;
};

std::vector<Subject> subjects() {
  return {{"formula", formula()},
          {"uniform", boxes()},
          {"rectilinear", stretched()},
          {"sheared", sheared()},
          {"tetrahedra", tets()}};
}

std::vector<Vec3> seeds_of(const VectorField& field, int count) {
  std::vector<Vec3> seeds = test::random_seeds(count, 0.2, 3);
  for (Vec3& x : seeds) x = field.bounds().center() + x * field.bounds().size();
  return seeds;
}

TraceOptions options_of(Integrator integrator, double tolerance, double length) {
  TraceOptions options;
  options.integrator = integrator;
  options.tolerance = tolerance;
  options.max_length = length;
  options.threads = 1;
  return options;
}

/// Ends of the lines that reached the length asked for; others are NaN.
std::vector<Vec3> ends_of(const TraceResult& result, std::size_t seeds) {
  std::vector<Vec3> ends(seeds, Vec3{NAN});
  for (const Line& line : result.lines) {
    if (line.end == End::kMaxLength) ends[line.seed] = line.points.back().position;
  }
  return ends;
}

double largest_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double worst = 0.0;
  std::size_t compared = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double distance = glm::distance(a[i], b[i]);
    if (!std::isfinite(distance)) continue;
    worst = std::max(worst, distance);
    ++compared;
  }
  EXPECT_GE(3 * compared, a.size()) << "too few lines reach the length to say anything";
  return worst;
}

// Half a diagonal of a field that turns and shears: some ten cells. Against the tightest method on the same
// interpolant, which is C0 only: an integrator that steps over faces falls to order two here.
TEST(Walks, FixedStepMethodsKeepTheirOrderOnEveryGrid) {
  for (const Subject& s : subjects()) {
    const std::vector<Vec3> seeds = seeds_of(*s.field, 12);
    const double length = 0.25 * s.field->diagonal();
    const auto exact =
        ends_of(trace_lines(*s.field, seeds, options_of(Integrator::kDp54, 1e-13, length)), seeds.size());
    for (const auto& [integrator, order] :
         {std::pair{Integrator::kEuler, 1.0}, std::pair{Integrator::kRk4, 4.0}}) {
      // Cut at faces, a step is no longer than what is left of its cell: the order shows below that.
      std::vector<double> error;
      for (const double parts : {100.0, 200.0, 400.0}) {
        TraceOptions options = options_of(integrator, 1e-6, length);
        options.step = length / parts;
        error.push_back(
            largest_distance(ends_of(trace_lines(*s.field, seeds, options), seeds.size()), exact));
      }
      EXPECT_NEAR(std::log2(error[0] / error[1]), order, 0.6) << s.name << " " << name_of(integrator);
      EXPECT_NEAR(std::log2(error[1] / error[2]), order, 0.6) << s.name << " " << name_of(integrator);
    }
  }
}

TEST(Walks, ErrorStaysBelowToleranceTimesAmplificationOnEveryGrid) {
  for (const Subject& s : subjects()) {
    const std::vector<Vec3> seeds = seeds_of(*s.field, 20);
    const double length = 0.25 * s.field->diagonal();
    const auto exact =
        ends_of(trace_lines(*s.field, seeds, options_of(Integrator::kDp54, 1e-13, length)), seeds.size());
    for (const Integrator integrator : kAdaptive) {
      double coarse = 0.0;
      for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
        const TraceResult result = trace_lines(*s.field, seeds, options_of(integrator, tolerance, length));
        const double error = largest_distance(ends_of(result, seeds.size()), exact) / s.field->diagonal();
        constexpr double kAmplification =
            10.0;  // of ABC flow over a quarter of a diagonal, in the worst of twenty lines
        EXPECT_LE(error, kAmplification * tolerance)
            << s.name << " " << name_of(integrator) << " " << tolerance;
        if (tolerance == 1e-4) coarse = error;
        if (tolerance == 1e-8) {
          EXPECT_LE(error, 0.05 * coarse) << s.name << " " << name_of(integrator);
        }
      }
    }
  }
}

TEST(Walks, IndependentMethodsAgreeOnTetrahedra) {
  const Field field = tets();
  const std::vector<Vec3> seeds = seeds_of(*field, 20);
  const double length = 0.25 * field->diagonal();
  const auto exact =
      ends_of(trace_lines(*field, seeds, options_of(Integrator::kExact, 1e-6, length)), seeds.size());
  const auto dp54 =
      ends_of(trace_lines(*field, seeds, options_of(Integrator::kDp54, 1e-13, length)), seeds.size());
  const auto rodas =
      ends_of(trace_lines(*field, seeds, options_of(Integrator::kRodas4, 1e-10, length)), seeds.size());
  EXPECT_LE(largest_distance(exact, dp54), 1e-10 * field->diagonal());
  EXPECT_LE(largest_distance(exact, rodas), 1e-8 * field->diagonal());
}

// The estimate is a sum of magnitudes carried along the line: at least a third of the true error on every
// line, and not absurdly more.
TEST(Walks, ErrorEstimateIsHonest) {
  for (const Subject& s : subjects()) {
    const std::vector<Vec3> seeds = seeds_of(*s.field, 30);
    const double length = 0.25 * s.field->diagonal();
    const TraceResult exact = trace_lines(*s.field, seeds, options_of(Integrator::kDp54, 1e-13, length));
    for (const Integrator integrator : kGeneral) {
      const TraceResult result = trace_lines(*s.field, seeds, options_of(integrator, 1e-5, length));
      std::vector<double> ratio;
      for (std::size_t i = 0; i < result.lines.size(); ++i) {
        if (result.lines[i].end != End::kMaxLength || exact.lines[i].end != End::kMaxLength) continue;
        const LinePoint &a = result.lines[i].points.back(), &b = exact.lines[i].points.back();
        // What lies across the flow is what the estimate speaks of.
        CellHint hint;
        const Vec3 n = glm::normalize(s.field->sample(b.position, hint).value);
        const Vec3 d = a.position - b.position;
        const double across = glm::length(d - glm::dot(d, n) * n);
        EXPECT_GE(3.0 * a.error, across) << s.name << " " << name_of(integrator) << " seed " << i;
        ratio.push_back(a.error / std::max(across, 1e-15));
      }
      ASSERT_GE(ratio.size(), 8u);
      std::nth_element(ratio.begin(), ratio.begin() + static_cast<std::ptrdiff_t>(ratio.size() / 2),
                       ratio.end());
      EXPECT_LE(ratio[ratio.size() / 2], 2000.0) << s.name << " " << name_of(integrator);
    }
  }
}

// eq. 6.15 of Ikits 2006: forward and back again.
TEST(Walks, ForwardThenBackReturnsWithinTheToleranceTimesTheAmplification) {
  for (const Subject& s : subjects()) {
    const std::vector<Vec3> seeds = seeds_of(*s.field, 20);
    const double length = 0.6 * s.field->diagonal();
    for (const Integrator integrator : kAdaptive) {
      const TraceResult there = trace_lines(*s.field, seeds, options_of(integrator, 1e-7, length));
      for (const Line& line : there.lines) {
        TraceOptions options = options_of(integrator, 1e-7, line.points.back().arc);
        options.forward = false;
        options.backward = true;
        const std::vector<Vec3> turn{line.points.back().position};
        const TraceResult back = trace_lines(*s.field, turn, options);
        if (back.lines.empty()) continue;  // on the border, outside by rounding
        const LinePoint& home = back.lines[0].points.back();
        // The way out's error is carried back by the inverse flow: both estimates together, either way.
        const double allowed = 10.0 * (home.error + line.points.back().error) + 1e-7 * length * 30.0;
        EXPECT_LE(glm::distance(home.position, seeds[line.seed]), allowed)
            << s.name << " " << name_of(integrator);
      }
    }
  }
}

void expect_same_bits(const TraceResult& a, const TraceResult& b, double length, double speed) {
  ASSERT_EQ(a.lines.size(), b.lines.size());
  for (std::size_t i = 0; i < a.lines.size(); ++i) {
    ASSERT_EQ(a.lines[i].points.size(), b.lines[i].points.size());
    EXPECT_EQ(a.lines[i].end, b.lines[i].end);
    for (std::size_t k = 0; k < a.lines[i].points.size(); ++k) {
      const LinePoint &p = a.lines[i].points[k], &q = b.lines[i].points[k];
      ASSERT_EQ(p.position * length, q.position);
      ASSERT_EQ(p.arc * length, q.arc);
      ASSERT_EQ(p.error * length, q.error);
      ASSERT_EQ(p.time * (length / speed), q.time);
      ASSERT_EQ(p.speed * speed, q.speed);
    }
  }
}

TEST(Walks, ScalingByPowersOfTwoScalesTheAnswerBitForBit) {
  const Mat3 a = test::rows(1, -8, 2, 8, 1, 0, 0, 1, 2);
  for (const auto& [length, speed] :
       {std::pair{60, 0}, std::pair{0, 60}, std::pair{-60, 60}, std::pair{100, -100}}) {
    const Field one = test::on_tetrahedra(a, {0.0625, 0.03125, 0.0}, 5, 0.3, 2);
    const Field two = test::on_tetrahedra(a, {0.0625, 0.03125, 0.0}, 5, 0.3, 2, 1.0, length, speed);
    std::vector<Vec3> seeds = test::random_seeds(15, 0.8, 4), scaled = seeds;
    for (Vec3& x : scaled) x *= std::ldexp(1.0, length);
    for (const Integrator integrator :
         {Integrator::kExact, Integrator::kRk4, Integrator::kDp54, Integrator::kRodas4}) {
      TraceOptions options;
      options.integrator = integrator;
      options.backward = true;
      expect_same_bits(trace_lines(*one, seeds, options), trace_lines(*two, scaled, options),
                       std::ldexp(1.0, length), std::ldexp(1.0, speed));
    }
  }
}

TEST(Walks, UniformDataScaledByPowersOfTwoGivesTheSameBits) {
  DataSet block = test::sample_uniform(*example("abc"), Index3{9}, test::SampledType::kFloat64);
  const Field one = made(block);
  constexpr double kLength = 0x1p60;
  auto& topology = std::get<UniformTopology>(block.topology);
  topology.origin *= kLength;
  topology.axes *= kLength;
  const Field two = made(block);
  std::vector<Vec3> seeds = seeds_of(*one, 15), scaled = seeds;
  for (Vec3& x : scaled) x *= kLength;
  for (const Integrator integrator : kGeneral) {
    TraceOptions options;
    options.integrator = integrator;
    expect_same_bits(trace_lines(*one, seeds, options), trace_lines(*two, scaled, options), kLength, 1.0);
  }
}

TEST(Walks, LinesDoNotDependOnTheNumberOfThreads) {
  for (const Subject& s : subjects()) {
    const std::vector<Vec3> seeds = seeds_of(*s.field, 60);
    TraceOptions options;
    options.backward = true;
    options.max_length = 2.0 * s.field->diagonal();
    options.threads = 1;
    const TraceResult one = trace_lines(*s.field, seeds, options);
    for (const int threads : {2, 3, 7}) {
      options.threads = threads;
      expect_same_bits(one, trace_lines(*s.field, seeds, options), 1.0, 1.0);
    }
  }
}

TEST(Walks, OutputSpacingPutsPointsAtEqualArcs) {
  for (const Subject& s : subjects()) {
    TraceOptions options;
    options.max_length = 0.5 * s.field->diagonal();
    options.step = 0.01 * s.field->diagonal();
    const TraceResult result = trace_lines(*s.field, seeds_of(*s.field, 5), options);
    for (const Line& line : result.lines) {
      for (std::size_t k = 1; k + 1 < line.points.size(); ++k) {
        EXPECT_NEAR(line.points[k].arc, static_cast<double>(k) * options.step, 1e-9 * s.field->diagonal())
            << s.name;
      }
    }
  }
}

}  // namespace
}  // namespace palpate
