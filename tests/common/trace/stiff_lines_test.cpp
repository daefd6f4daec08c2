// Lines that are drawn onto a slow manifold by rates up to 1e6, against closed forms, on every kind of grid.

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/index.h"
#include "common/field/analytic/examples.h"
#include "common/trace/trace.h"
#include "lab/extremes/stiff_layer.h"
#include "tests/common/trace/linear_fields.h"
#include "tests/support/sampled.h"

namespace palpate::test {
namespace {

using Field = std::shared_ptr<const VectorField>;

constexpr double kRates[] = {1.0, 30.0, 1e3, 3e4, 1e6};

Field field_of(const DataSet& block) {
  return make_vector_field({block}, VectorChoice{.arrays = {kSampledName}, .label = "velocity"}, "sampled");
}

struct Grid {
  std::string name;
  Field field;
};

std::vector<Grid> grids(const std::shared_ptr<const AnalyticField>& formula, bool tetrahedra) {
  const Index3 points{17, 9, 9};
  std::vector<Grid> all{
      {"formula", make_vector_field(formula)},
      {"uniform", field_of(sample_uniform(*formula, points, SampledType::kFloat64))},
      {"rectilinear", field_of(sample_rectilinear(*formula, points, 3.0, SampledType::kFloat64))}};
  if (tetrahedra) {
    all = {{"tetrahedra", field_of(sample_tetrahedra(*formula, points, 0.2, 3, SampledType::kFloat64))}};
  }
  return all;
}

std::vector<Vec3> seeds_in(const Box& box, int count) {
  std::vector<Vec3> seeds = random_seeds(count, 0.45, 11);
  for (Vec3& x : seeds) x = box.center() + x * box.size();
  return seeds;
}

std::size_t count_of(const TraceResult& result, End end) { return result.ends[as_size(end)]; }

TEST(StiffLines, FollowTheLayerToTheBorderAtEveryRateOnEveryGrid) {
  for (const double rate : kRates) {
    for (const double c : {0.0, 0.2}) {
      const auto layer = std::make_shared<StiffLayer>(rate, c);
      for (const Grid& grid : grids(layer, c == 0.0)) {
        const auto seeds = seeds_in(layer->bounds(), 12);
        for (const Integrator integrator : {Integrator::kDp54, Integrator::kRodas4}) {
          const std::string what =
              grid.name + ", rate " + std::to_string(rate) + ", " + std::string(name_of(integrator));
          TraceOptions options{.integrator = integrator, .threads = 1};
          options.max_steps = 20'000;
          const TraceResult result = trace_lines(*grid.field, seeds, options);
          EXPECT_EQ(count_of(result, End::kLeftDomain), seeds.size()) << what;
          double worst = 0.0, stated = 0.0;
          std::size_t steps = 0;
          for (const Line& line : result.lines) {
            for (const LinePoint& p : line.points) {
              worst = std::max(worst, layer->distance(seeds[line.seed], p.position));
            }
            stated = std::max(stated, line.points.back().error);
            steps = std::max(steps, line.points.size());
          }
          // Lines are up to two diagonals long, and the way into the layer turns at once.
          EXPECT_LE(worst, 4.0 * options.tolerance * grid.field->diagonal()) << what;
          EXPECT_LE(worst, 3.0 * stated + 1e-12) << what;
          EXPECT_LE(stated, 100.0 * options.tolerance * grid.field->diagonal()) << what;
          EXPECT_LE(steps, 2000U) << what;
        }
      }
    }
  }
}

// The example is drawn to z = g = 0.15 sin x cos y, at 1e6, along (1, 0.3 cos 2x).
TEST(StiffLines, TheBoundaryLayerOfTheExamplesIsFollowed) {
  const auto formula = example("boundary-layer");
  const auto field = make_vector_field(formula);
  const auto seeds = seeds_in(formula->bounds(), 20);
  for (const Integrator integrator : {Integrator::kDp54, Integrator::kRodas4}) {
    const TraceResult result = trace_lines(*field, seeds, {.integrator = integrator, .threads = 1});
    EXPECT_EQ(count_of(result, End::kLeftDomain), seeds.size()) << name_of(integrator);
    for (const Line& line : result.lines) {
      const Vec3 x = line.points.back().position, s = seeds[line.seed];
      const double y = s.y + 0.15 * (std::sin(2.0 * x.x) - std::sin(2.0 * s.x));
      EXPECT_NEAR(x.y, y, 5e-5) << name_of(integrator);
      EXPECT_NEAR(x.z, 0.15 * std::sin(x.x) * std::cos(y), 5e-5) << name_of(integrator);
    }
  }
}

// Sampled, the layer is another: no closed form, but two methods, of which one may go over to the other, agree.
TEST(StiffLines, SampledBoundaryLayersEndNowhereWithin) {
  const auto formula = example("boundary-layer");
  const auto seeds = seeds_in(formula->bounds(), 5);
  for (const Grid& grid : grids(formula, false)) {
    const auto traced = [&](Integrator integrator, double tolerance) {
      return trace_lines(*grid.field, seeds,
                         {.integrator = integrator, .tolerance = tolerance, .threads = 1});
    };
    const TraceResult a = traced(Integrator::kDp54, 1e-6), b = traced(Integrator::kRodas4, 1e-7);
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      EXPECT_EQ(a.lines[i].end, End::kLeftDomain) << grid.name;
      EXPECT_LE(glm::distance(a.lines[i].points.back().position, b.lines[i].points.back().position),
                1e-4 * grid.field->diagonal())
          << grid.name;
    }
  }
}

TEST(StiffLines, GoOverToTheStiffMethodWhereItPaysAndBack) {
  // Stiff on the left only: the rate is 1e5 up to x = 1 and falls to 1 by x = 1.2.
  struct Half final : public AnalyticField {
    [[nodiscard]] static double rate(double x) {
      const double u = std::clamp((x - 1.0) / 0.2, 0.0, 1.0);
      return std::pow(10.0, 5.0 * (1.0 - u));
    }
    [[nodiscard]] Vec3 velocity(const Vec3& x) const noexcept override {
      return {1.0, 0.2 * std::sin(9.0 * x.x), -rate(x.x) * x.z};
    }
    [[nodiscard]] Mat3 jacobian(const Vec3& x) const noexcept override {
      const bool ramp = x.x > 1.0 && x.x < 1.2;
      const double slope = ramp ? -std::log(10.0) * 25.0 * rate(x.x) : 0.0;
      return rows(0, 0, 0, 1.8 * std::cos(9.0 * x.x), 0, 0, -slope * x.z, 0, -rate(x.x));
    }
    [[nodiscard]] Box bounds() const noexcept override { return {{0.0, -1.0, -1.0}, {4.0, 1.0, 1.0}}; }
    [[nodiscard]] std::string name() const override { return "half"; }
    [[nodiscard]] std::string description() const override { return "half"; }
  };
  const auto field = make_vector_field(std::make_shared<Half>());
  const std::vector<Vec3> seeds{{0.1, 0.0, 0.5}};
  const auto steps = [&](Integrator integrator, const VectorField& of) {
    const TraceResult result =
        trace_lines(of, seeds, {.integrator = integrator, .tolerance = 1e-8, .threads = 1});
    EXPECT_EQ(result.ends[as_size(End::kLeftDomain)], seeds.size());
    return result.steps;
  };
  const StepCounts both = steps(Integrator::kDp54, *field);
  EXPECT_GT(both[as_size(Integrator::kRodas4)], 20);
  EXPECT_GT(both[as_size(Integrator::kDp54)], 60);
  // Neither alone does with as few.
  EXPECT_LT(both[as_size(Integrator::kRodas4)],
            steps(Integrator::kRodas4, *field)[as_size(Integrator::kRodas4)]);
  // Flows that are not stiff never leave dp54.
  const StepCounts plain =
      steps(Integrator::kDp54, *make_vector_field(std::make_shared<StiffLayer>(1.0, 0.2)));
  EXPECT_EQ(plain[as_size(Integrator::kRodas4)], 0);
  EXPECT_GT(plain[as_size(Integrator::kDp54)], 0);
}

// Slow where it has to be: at sinks of any stiffness, seen from either rate.
TEST(StiffLines, StiffSinksAreReached) {
  const Vec3 sink{0.1, 0.05, 0.02};
  for (const double rate : kRates) {
    const auto field =
        make_vector_field(std::make_shared<LinearField>(rows(-1, 0, 0, 0, -2, 0, rate, 0, -rate), sink));
    for (const Integrator integrator : {Integrator::kDp54, Integrator::kRodas4}) {
      const TraceResult result =
          trace_lines(*field, random_seeds(10, 0.5, 1), {.integrator = integrator, .threads = 1});
      EXPECT_EQ(count_of(result, End::kStagnation), 10U) << rate << name_of(integrator);
      for (const Line& line : result.lines) {
        EXPECT_LE(glm::distance(line.points.back().position, sink), 1e-5) << rate << name_of(integrator);
      }
    }
  }
}

// A saddle turns lines away, however near they pass; only what has no part along the way out comes to rest.
TEST(StiffLines, SaddlesAreNoPointsOfRestForLinesThatPassThem) {
  const auto field =
      make_vector_field(std::make_shared<LinearField>(rows(1, 0, 0, 0, -1, 0, 0, 0, -2), Vec3{0.0}));
  for (const double aside : {1e-7, 1e-9, -1e-12}) {
    const std::vector<Vec3> seeds{{aside, 0.5, 0.25}};
    for (const Integrator integrator : {Integrator::kDp54, Integrator::kRodas4}) {
      const Line line = trace_lines(*field, seeds, {.integrator = integrator}).lines.at(0);
      EXPECT_EQ(line.end, End::kLeftDomain) << aside << name_of(integrator);
      EXPECT_NEAR(line.points.back().position.x, std::copysign(1.0, aside), 1e-9);
    }
  }
  const std::vector<Vec3> seeds{{0.0, 0.5, 0.25}};
  EXPECT_EQ(trace_lines(*field, seeds, {.integrator = Integrator::kDp54}).lines.at(0).end, End::kStagnation);
}

/// Drawn onto the x axis: y and z fall as exp(-rate x).
class Contraction final : public AnalyticField {
 public:
  explicit Contraction(double rate) : rate_(rate) {}
  [[nodiscard]] Vec3 velocity(const Vec3& x) const noexcept override {
    return {1.0, -rate_ * x.y, -rate_ * x.z};
  }
  [[nodiscard]] Mat3 jacobian(const Vec3&) const noexcept override {
    return rows(0, 0, 0, 0, -rate_, 0, 0, 0, -rate_);
  }
  [[nodiscard]] Box bounds() const noexcept override { return {{0.0, -1.0, -1.0}, {2.0, 1.0, 1.0}}; }
  [[nodiscard]] std::string name() const override { return "contraction"; }
  [[nodiscard]] std::string description() const override { return "contraction"; }

  /// Of `x` from the line through `seed`, to leading order.
  [[nodiscard]] double distance(const Vec3& seed, const Vec3& x) const {
    const double part = std::exp(-rate_ * (x.x - seed.x));
    const double aside = std::hypot(x.y - part * seed.y, x.z - part * seed.z);
    return aside / std::hypot(1.0, rate_ * part * std::hypot(seed.y, seed.z));
  }

 private:
  double rate_;
};

// A step contracts an error by R(hJ), not by exp(hJ): near the border of its stability by next to nothing.
TEST(StiffLines, StatedErrorsCoverWhatStepsDoNotContract) {
  const std::vector<Vec3> seeds{{0.01, 0.9, 0.3}, {0.02, -0.05, 0.7}};
  for (const double rate : {4.0, 40.0, 400.0}) {
    const auto formula = std::make_shared<Contraction>(rate);
    const Field field = make_vector_field(formula);
    for (const Integrator integrator :
         {Integrator::kRk34, Integrator::kDp54, Integrator::kRodas4, Integrator::kBs32, Integrator::kRk4}) {
      for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
        TraceOptions options;
        options.integrator = integrator;
        options.tolerance = tolerance;
        if (integrator == Integrator::kRk4) {
          if (rate > 100.0) continue;  // beyond its stability
          options.step = 0.5 / rate * std::cbrt(std::cbrt(tolerance));
        }
        double worst = 0.0;
        for (const Line& line : trace_lines(*field, seeds, options).lines) {
          for (const LinePoint& point : line.points) {
            const double off = formula->distance(seeds[line.seed], point.position);
            worst = std::max(worst, off / (point.error + 1e-15));
          }
        }
        EXPECT_LT(worst, 1.5) << name_of(integrator) << " rate " << rate << " tolerance " << tolerance;
      }
    }
  }
}

/// Drawn at two rates onto the curve y = A sin 5x, z = B cos 5x, which is a line itself.
class CurvedManifold final : public AnalyticField {
 public:
  explicit CurvedManifold(double rate) : rate_(rate), other_(0.37 * rate) {}
  [[nodiscard]] Vec3 velocity(const Vec3& x) const noexcept override {
    const double s = std::sin(kW * x.x), c = std::cos(kW * x.x);
    return {1.0, kA * kW * c - rate_ * (x.y - kA * s), -kB * kW * s - other_ * (x.z - kB * c)};
  }
  [[nodiscard]] Mat3 jacobian(const Vec3& x) const noexcept override {
    const double s = std::sin(kW * x.x), c = std::cos(kW * x.x);
    return rows(0, 0, 0, kA * kW * (rate_ * c - kW * s), -rate_, 0, -kB * kW * (kW * c + other_ * s), 0,
                -other_);
  }
  [[nodiscard]] Box bounds() const noexcept override { return {{0.0, -1.0, -1.0}, {2.0, 1.0, 1.0}}; }
  [[nodiscard]] std::string name() const override { return "manifold"; }
  [[nodiscard]] std::string description() const override { return "manifold"; }

  /// Of `x` from the line through `seed`, to leading order.
  [[nodiscard]] double distance(const Vec3& seed, const Vec3& x) const {
    const auto on = [](double at) { return Vec3{at, kA * std::sin(kW * at), kB * std::cos(kW * at)}; };
    const Vec3 from = seed - on(seed.x);
    const double t = x.x - seed.x;
    const Vec3 there = on(x.x) + Vec3{0.0, from.y * std::exp(-rate_ * t), from.z * std::exp(-other_ * t)};
    const Vec3 along = glm::normalize(velocity(there));
    return glm::length(x - there - glm::dot(x - there, along) * along);
  }

 private:
  static constexpr double kA = 0.3, kB = 0.2, kW = 5.0;
  double rate_, other_;
};

// There the step is as long as the rate allows, where the estimate of bs32 passes through zero.
TEST(StiffLines, StatedErrorsHoldOnCurvedManifolds) {
  const std::vector<Vec3> seeds{{0.1, 0.7, -0.4}, {0.3, -0.2, 0.6}, {0.5, -0.8, -0.7}};
  for (const Integrator integrator : {Integrator::kBs32, Integrator::kRk4}) {
    std::size_t points = 0, understated = 0;
    for (const double rate : {100.0, 1000.0}) {
      const auto formula = std::make_shared<CurvedManifold>(rate);
      const Field field = make_vector_field(formula);
      for (const double tolerance : {1e-5, 1e-7}) {
        TraceOptions options{.integrator = integrator, .tolerance = tolerance, .threads = 1};
        options.max_steps = 100'000;
        if (integrator == Integrator::kRk4) options.step = (tolerance > 1e-6 ? 1.8 : 0.5) / rate;
        for (const Line& line : trace_lines(*field, seeds, options).lines) {
          EXPECT_EQ(line.end, End::kLeftDomain) << name_of(integrator) << rate;
          for (const LinePoint& point : line.points) {
            ++points;
            understated += formula->distance(seeds[line.seed], point.position) > point.error ? 1U : 0U;
          }
        }
      }
    }
    EXPECT_LE(static_cast<double>(understated), 1e-3 * static_cast<double>(points)) << name_of(integrator);
  }
}

}  // namespace
}  // namespace palpate::test
