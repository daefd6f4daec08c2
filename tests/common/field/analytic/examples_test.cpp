#include "common/field/analytic/examples.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace palpate {
namespace {

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }
Vec3 random_in(const Box& box, std::mt19937_64& random) {
  return box.lower + box.size() * Vec3{unit(random), unit(random), unit(random)};
}

TEST(Examples, AreNamedAndUnknownNamesListThem) {
  const auto all = examples();
  EXPECT_EQ(all.size(), 6U);
  for (const ExampleInfo& info : all) EXPECT_EQ(example(info.name)->description(), info.summary);
  try {
    (void)example("nothing");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    for (const ExampleInfo& info : all)
      EXPECT_NE(std::string(error.what()).find(info.name), std::string::npos);
  }
}

// Central differences have an error of h^2/6 times third derivatives, and of rounding over h.
TEST(Examples, JacobiansAreTheDerivatives) {
  std::mt19937_64 random(1);
  for (const ExampleInfo& info : examples()) {
    const auto field = example(info.name);
    const double h = 1e-5 * field->bounds().diagonal();
    for (int i = 0; i < 200; ++i) {
      const Vec3 x = random_in(field->bounds(), random);
      if (info.name == "hill" && std::abs(glm::length(x) - 1.0) < 2.0 * h) continue;  // a kink
      const Mat3 m = field->jacobian(x);
      double size = 1.0;
      for (int c = 0; c < 3; ++c) size = std::max(size, glm::length(m[c]));
      for (int c = 0; c < 3; ++c) {
        Vec3 step{0.0};
        step[c] = h;
        const Vec3 difference = (field->velocity(x + step) - field->velocity(x - step)) / (2.0 * h);
        EXPECT_LT(glm::distance(difference, m[c]), 1e-5 * size) << info.name;
      }
    }
  }
}

TEST(Examples, FlowsAreFreeOfDivergenceButForTheBoundaryLayer) {
  std::mt19937_64 random(2);
  for (const ExampleInfo& info : examples()) {
    if (info.name == "boundary-layer") continue;
    const auto field = example(info.name);
    for (int i = 0; i < 200; ++i) {
      const Mat3 m = field->jacobian(random_in(field->bounds(), random));
      double size = 1.0;
      for (int c = 0; c < 3; ++c) size = std::max(size, glm::length(m[c]));
      EXPECT_LT(std::abs(m[0][0] + m[1][1] + m[2][2]), 1e-13 * size) << info.name;
    }
  }
}

TEST(Examples, AbcFlowIsItsOwnCurl) {
  std::mt19937_64 random(3);
  const auto field = example("abc");
  for (int i = 0; i < 100; ++i) {
    const Vec3 x = random_in(field->bounds(), random);
    const Mat3 m = field->jacobian(x);
    const Vec3 curl{m[1][2] - m[2][1], m[2][0] - m[0][2], m[0][1] - m[1][0]};
    EXPECT_LT(glm::distance(curl, field->velocity(x)), 1e-14);
  }
}

TEST(Examples, HillsVortexIsContinuousAndKeepsItsSphere) {
  std::mt19937_64 random(4);
  const auto field = example("hill");
  for (int i = 0; i < 200; ++i) {
    const Vec3 n = glm::normalize(random_in({Vec3{-1.0}, Vec3{1.0}}, random));
    const Vec3 inside = field->velocity(n * (1.0 - 1e-9));
    const Vec3 outside = field->velocity(n * (1.0 + 1e-9));
    EXPECT_LT(glm::distance(inside, outside), 1e-7);
    EXPECT_LT(std::abs(glm::dot(inside, n)), 1e-8);  // nothing crosses the sphere
  }
  // Stokes' stream function -3/4 r^2 (1 - R^2) is kept inside: its gradient is normal to the flow.
  for (int i = 0; i < 200; ++i) {
    const Vec3 x = 0.55 * random_in({Vec3{-1.0}, Vec3{1.0}}, random);
    const double r2 = x.x * x.x + x.y * x.y;
    const double gap = 1.0 - glm::dot(x, x);
    const Vec3 gradient{2.0 * x.x * gap - 2.0 * x.x * r2, 2.0 * x.y * gap - 2.0 * x.y * r2, -2.0 * x.z * r2};
    EXPECT_LT(std::abs(glm::dot(field->velocity(x), gradient)), 1e-14);
  }
}

TEST(Examples, CavityRestsOnItsWallsAndMovesWithItsLid) {
  std::mt19937_64 random(5);
  const auto field = example("cavity");
  for (int i = 0; i < 100; ++i) {
    const double s = unit(random);
    const double t = unit(random);
    for (const Vec3& wall :
         {Vec3{0.0, s, t}, Vec3{1.0, s, t}, Vec3{s, 0.0, t}, Vec3{s, 1.0, t}, Vec3{s, t, 0.0}}) {
      EXPECT_LT(glm::length(field->velocity(wall)), 1e-15);
    }
    const Vec3 lid = field->velocity({s, t, 1.0});
    EXPECT_GE(lid.x, 0.0);
    EXPECT_EQ(lid.y, 0.0);
    EXPECT_EQ(lid.z, 0.0);
  }
  EXPECT_NEAR(field->velocity({0.5, 0.5, 1.0}).x, 1.0, 1e-14);
}

TEST(Examples, SaddleHasItsEigenvectors) {
  const Mat3 m = example("saddle")->jacobian(Vec3{0.0});
  const std::array<Vec3, 3> q{Vec3{2, 1, 2} / 3.0, Vec3{1, 2, -2} / 3.0, Vec3{2, -2, -1} / 3.0};
  const std::array<double, 3> lambda{1.0, 0.5, -1.5};
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(glm::distance(m * q[i], lambda[i] * q[i]), 1e-15);
}

TEST(Examples, BoundaryLayerDrawsToItsSurface) {
  const auto field = example("boundary-layer");
  const Mat3 m = field->jacobian({1.0, 0.5, 0.1});
  EXPECT_EQ(m[2][2], -1e6);
  EXPECT_EQ(m[2][0], 0.0);  // the eigenvalue -1e6 stands alone: the first two components ignore z
  EXPECT_EQ(m[2][1], 0.0);
  const double g = 0.15 * std::sin(1.0) * std::cos(0.5);
  EXPECT_LT(glm::length(field->velocity({1.0, 0.5, g})), 2.0);
}

}  // namespace
}  // namespace palpate
