#include "common/trace/walk/error_ellipse.h"

#include <gtest/gtest.h>

#include "common/field/analytic/examples.h"
#include "common/trace/trace.h"
#include "tests/support/sampled.h"

namespace palpate::test {
namespace {

/// A method whose steps are the flow.
auto exact(double h) {
  return [h](const Mat3& j, const Vec3& e) { return linear_growth(j, h) * e; };
}

constexpr Vec3 kAlongZ{0.0, 0.0, 1.0};

/// `steps` steps of length h under J = diag(x, y, 0), each with a local error of 1.
void carry(ErrorEllipse& ellipse, double x, double y, int steps, double h) {
  const Mat3 j{{x, 0, 0}, {0, y, 0}, {0, 0, 0}};
  for (int i = 0; i < steps; ++i) {
    ellipse.advance([&](const Vec3& e) { return j * e; }, [&] { return j; }, exact(h), h);
    ellipse.add(1.0, kAlongZ);
  }
}

/// What the errors of n steps add up to along an axis of growth g: (1) of error_ellipse.h, a geometric sum.
double sum(double start, double growth, int steps) {
  double e = start;
  for (int i = 0; i < steps; ++i) e = e * growth + 1.0;
  return e;
}

// One direction grows first and the other one later: the errors of the first part lie along the wrong one.
TEST(ErrorEllipse, IsReadyForGrowthInEitherDirection) {
  ErrorEllipse ellipse;
  ellipse.start(kAlongZ, 1e-12);
  constexpr double h = 0.01;
  carry(ellipse, 1.0, -1.0, 500, h);
  carry(ellipse, -1.0, 1.0, 900, h);
  const double grow = 1.0 + h, fall = 1.0 - h;
  const double x = sum(sum(1e-12, grow, 500), fall, 900);
  const double y = sum(sum(1e-12, fall, 500), grow, 900);
  ASSERT_GT(y, 10.0 * x);
  EXPECT_NEAR(ellipse.distance(kAlongZ, 1.0, 0.0), y, 0.02 * y);
}

// Under rotation and shear no direction is special: the largest error is that of the matrix, its norm.
TEST(ErrorEllipse, CarriesAnyDirectionThroughARotation) {
  ErrorEllipse ellipse;
  ellipse.start(kAlongZ, 1.0);
  const Mat3 j{{0, 1, 0}, {-1, 0, 0}, {0, 0, 0}};
  for (int i = 0; i < 1000; ++i)
    ellipse.advance([&](const Vec3& e) { return j * e; }, [&] { return j; }, exact(1e-3), 1e-3);
  ellipse.add(0.0, kAlongZ);
  EXPECT_NEAR(ellipse.distance(kAlongZ, 1.0, 0.0), 1.0, 1e-3);
}

TEST(ErrorEllipse, LeavesOutWhatLiesAlongTheFlow) {
  ErrorEllipse ellipse;
  ellipse.start(kAlongZ, 1.0);
  const Mat3 shear{{0, 0, 5}, {0, 0, 5}, {0, 0, 0}};  // across becomes along
  for (int i = 0; i < 10; ++i) {
    ellipse.advance([&](const Vec3& e) { return shear * e; }, [&] { return shear; }, exact(0.05), 0.05);
    ellipse.add(0.0, kAlongZ);
  }
  EXPECT_NEAR(ellipse.distance(kAlongZ, 1.0, 0.0), 1.0, 1e-12);
}

TEST(ErrorEllipse, ScalesByPowersOfTwoBitForBit) {
  ErrorEllipse one;
  ErrorEllipse scaled;
  one.start(kAlongZ, 1e-9);
  scaled.start(kAlongZ, 0x1p60 * 1e-9);
  const Mat3 j{{0.3, 1, 0}, {-0.7, 0.2, 0}, {0.1, 0.5, 0}};
  for (int i = 0; i < 100; ++i) {
    for (ErrorEllipse* e : {&one, &scaled})
      e->advance([&](const Vec3& d) { return j * d; }, [&] { return j; }, exact(0.1), 0.1);
    one.add(1e-10, kAlongZ);
    scaled.add(0x1p60 * 1e-10, kAlongZ);
  }
  EXPECT_EQ(scaled.distance(kAlongZ, 1.0, 0.0), 0x1p60 * one.distance(kAlongZ, 1.0, 0.0));
}

// rk34 estimates the error of the very solution it keeps: its statement has to hold all the same.
TEST(Rk34, StatesAtLeastItsDistanceFromTheCurveOnNineLinesOfTen) {
  const auto data = sample_uniform(*example("abc"), {40, 40, 40});
  const auto field =
      make_vector_field({data}, VectorChoice{.arrays = {kSampledName}, .label = "velocity"}, "sampled");
  std::vector<Vec3> seeds;
  for (int i = 0; i < 60; ++i) {
    const Vec3 part{0.1 + 0.8 * ((i * 7) % 60) / 60.0, 0.1 + 0.8 * ((i * 23) % 60) / 60.0,
                    0.1 + 0.8 * i / 60.0};
    seeds.push_back(field->bounds().lower + part * field->bounds().size());
  }
  TraceOptions options{.integrator = Integrator::kDp54, .tolerance = 1e-12};
  options.step = field->diagonal() / 100;
  options.max_length = 2.0 * field->diagonal();
  const auto reference = trace_lines(*field, seeds, options).lines;
  for (const double tolerance : {1e-6, 1e-7}) {
    options.integrator = Integrator::kRk34;
    options.tolerance = tolerance;
    const auto lines = trace_lines(*field, seeds, options).lines;
    std::size_t covered = 0;
    for (std::size_t l = 0; l < lines.size(); ++l) {
      bool holds = true;
      CellHint hint;
      for (std::size_t p = 1; p + 1 < std::min(lines[l].points.size(), reference[l].points.size()); ++p) {
        const LinePoint& point = lines[l].points[p];
        const LinePoint& truth = reference[l].points[p];
        const Vec3 v = field->sample(truth.position, hint).value;
        const Vec3 e = point.position - truth.position;
        holds = holds && glm::length(e - glm::dot(e, v) / glm::dot(v, v) * v) <= point.error;
      }
      covered += holds ? 1 : 0;
    }
    EXPECT_GE(covered, lines.size() * 9 / 10) << tolerance << ", of " << lines.size();
  }
}

}  // namespace
}  // namespace palpate::test
