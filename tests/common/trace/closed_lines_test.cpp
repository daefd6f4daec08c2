// Closed lines end at their first return: one turn long, at the seed, within their error.

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/trace/trace.h"
#include "tests/common/trace/linear_fields.h"
#include "tests/support/sampled.h"

namespace palpate::test {
namespace {

struct Way {
  std::string name;
  std::shared_ptr<const VectorField> field;
  Integrator integrator;
};

std::vector<Way> ways(const Mat3& a, const Vec3& c) {
  const LinearField linear(a, c);
  const auto formula = make_vector_field(std::make_shared<LinearField>(a, c));
  const auto lattice =
      make_vector_field({sample_uniform(linear, Index3{9}, SampledType::kFloat64)},
                        VectorChoice{.arrays = {kSampledName}, .label = "velocity"}, "sampled");
  const auto tets = on_tetrahedra(a, c, 6, 0.3, 7);
  std::vector<Way> all{{"exact", tets, Integrator::kExact}};
  for (const Integrator i :
       {Integrator::kBs32, Integrator::kRk34, Integrator::kDp54, Integrator::kRodas4, Integrator::kRk4}) {
    const std::string name{name_of(i)};
    all.push_back({name + " on a formula", formula, i});
    all.push_back({name + " on a lattice", lattice, i});
    all.push_back({name + " on tetrahedra", tets, i});
  }
  return all;
}

/// Length of the ellipse of semi-axes a >= b.
double ellipse_length(double a, double b) {
  return 4.0 * a * std::comp_ellint_2(std::sqrt(1.0 - b * b / (a * a)));
}

// v = (-p y, y-axis q x): ellipses x^2 q + y^2 p = constant; p = q is a rigid rotation.
TEST(ClosedLines, EndAtTheirFirstReturn) {
  const Vec3 c{0.03, 0.02, 0.0};
  for (const double q : {2.0, 0.5, 6.0}) {
    constexpr double p = 2.0;
    for (const Way& way : ways(rows(0, -p, 0, q, 0, 0, 0, 0, 0), c)) {
      for (const double radius : {0.4, 0.11}) {
        for (const double angle : {0.0, 1.1}) {
          // On the ellipse of semi-axes radius and radius sqrt(q / p) along x and y.
          const double other = radius * std::sqrt(q / p);
          const Vec3 seed = c + Vec3{radius * std::cos(angle), other * std::sin(angle), 0.1};
          const double turn = ellipse_length(std::max(radius, other), std::min(radius, other));
          const std::vector<Vec3> seeds{seed};
          for (const bool forward : {true, false}) {
            TraceOptions options{
                .integrator = way.integrator, .forward = forward, .backward = !forward, .threads = 1};
            if (way.integrator == Integrator::kRk4) options.step = 0.02 * radius;
            const Line line = trace_lines(*way.field, seeds, options).lines.at(0);
            const LinePoint& last = line.points.back();
            const std::string what =
                way.name + ", q " + std::to_string(q) + ", radius " + std::to_string(radius);
            EXPECT_EQ(line.end, End::kLoop) << what << " " << name_of(line.end);
            EXPECT_LE(glm::distance(last.position, seed), 4.0 * last.error) << what;
            // A ring that is off by an error all around is longer by 2 pi of it; arcs are sums of quadratures.
            EXPECT_NEAR(last.arc, turn, 8.0 * last.error + 1e-10) << what;
            EXPECT_NEAR(std::abs(last.time), 2.0 * std::numbers::pi / std::sqrt(p * q),
                        8.0 * last.error / last.speed + 1e-12 + 1e-4 * turn / last.speed)
                << what;
          }
        }
      }
    }
  }
}

// Outside the cycle lines run onto it and end there too, after at most three turns of it.
TEST(ClosedLines, LimitCyclesEndLinesThatRunOntoThem) {
  struct Cycle final : public AnalyticField {
    [[nodiscard]] Vec3 velocity(const Vec3& x) const noexcept override {
      const double r = 0.25 - x.x * x.x - x.y * x.y;
      return {-x.y + 40.0 * r * x.x, x.x + 40.0 * r * x.y, -x.z};
    }
    [[nodiscard]] Mat3 jacobian(const Vec3& x) const noexcept override {
      const double r = 0.25 - x.x * x.x - x.y * x.y;
      return rows(40.0 * r - 80.0 * x.x * x.x, -1.0 - 80.0 * x.x * x.y, 0, 1.0 - 80.0 * x.x * x.y,
                  40.0 * r - 80.0 * x.y * x.y, 0, 0, 0, -1);
    }
    [[nodiscard]] Box bounds() const noexcept override { return {Vec3{-1.0}, Vec3{1.0}}; }
    [[nodiscard]] std::string name() const override { return "cycle"; }
    [[nodiscard]] std::string description() const override { return "cycle"; }
  };
  const auto field = make_vector_field(std::make_shared<Cycle>());
  const std::vector<Vec3> seeds{{0.9, 0.0, 0.0}, {0.1, 0.05, 0.0}};
  for (const Line& line : trace_lines(*field, seeds, {.tolerance = 1e-5, .threads = 1}).lines) {
    EXPECT_EQ(line.end, End::kLoop) << name_of(line.end);
    EXPECT_NEAR(glm::length(Vec2(line.points.back().position)), 0.5, 1e-3);
    EXPECT_LE(line.points.back().arc, 0.5 + 5.0 * std::numbers::pi);
  }
}

// Seeds on vertices, edges and faces, where rounding may first move a line back: it has not returned.
TEST(ClosedLines, LinesThatLeaveTheirSeedAreOpen) {
  const Mat3 helix = rows(0, -1, 0, 1, 0, 0, 0, 0, 0.5);
  std::vector<Vec3> seeds;
  for (int k = 0; k < 5; ++k) {
    for (int j = 0; j < 9; ++j) {
      for (int i = 0; i < 9; ++i) seeds.push_back(Vec3{-0.8, -0.8, -0.9} + Vec3{0.2 * i, 0.2 * j, 0.15 * k});
    }
  }
  for (const double speed : {1e-30, 0.7, 1.0, 3e7, 1e30}) {
    const LinearField flow(speed * helix, {-0.3, 0.0, -3.0});
    const auto field =
        make_vector_field({sample_tetrahedra(flow, Index3{6}, 0.0, 1, SampledType::kFloat64)},
                          VectorChoice{.arrays = {kSampledName}, .label = "velocity"}, "sampled");
    for (const Line& line : trace_lines(*field, seeds, {.backward = true, .threads = 1}).lines)
      EXPECT_EQ(line.end, End::kLeftDomain) << speed << ", seed " << line.seed << ": " << name_of(line.end);
  }
}

}  // namespace
}  // namespace palpate::test
