// Models that devices evaluate: arms, polynomials, tables, splines, and the correction of a pose.

#include <array>
#include <cmath>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "common/kinematics/dhh_chain.h"
#include "common/kinematics/tracker_correction.h"

namespace palpate::test {
namespace {

constexpr double kRounding = 1e-12;

Vec3 random_vector(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> within(-size, size);
  const double x = within(random), y = within(random), z = within(random);
  return {x, y, z};
}

// The same product from homogeneous matrices, one elementary motion at a time.
TEST(DhhChain, IsTheProductOfItsElementaryMotions) {
  std::mt19937 random{3};
  for (int round = 0; round < 50; ++round) {
    DhhChain arm = nominal_phantom_3();
    std::array<double, 6> readings{};
    for (double& reading : readings) reading = random_vector(random, 2.0).x;
    Mat4 expected{1.0};
    for (DhhRow& row : arm.rows) {
      for (double& value : row.values) value += random_vector(random, 0.3).x;
      const auto& [d, a, alpha, beta, gamma] = row.values;
      const double psi = row.joint < 0 ? 0.0 : readings[static_cast<std::size_t>(row.joint)];
      expected = glm::rotate(expected, psi + gamma, Vec3{0, 0, 1});
      expected = glm::translate(expected, Vec3{0, 0, d});
      expected = glm::translate(expected, Vec3{a, 0, 0});
      expected = glm::rotate(expected, alpha, Vec3{1, 0, 0});
      expected = glm::rotate(expected, beta, Vec3{0, 1, 0});
    }
    const Rigid pose = arm.forward(readings);
    const Vec3 x = random_vector(random, 1.0);
    EXPECT_LT(glm::distance(pose * x, Vec3(expected * Vec4(x, 1.0))), kRounding);
    EXPECT_LT(glm::distance(pose.inverse() * (pose * x), x), kRounding);
  }
}

// Table 4.2 leaves 27 parameters free: four a joint for all but the last, three of the probe, and the base's.
TEST(DhhChain, NominalPhantomHasTheFreeParametersOfTable42) {
  int free = 0;
  for (const DhhRow& row : nominal_phantom_3().rows) {
    for (const bool is_free : row.free) free += is_free ? 1 : 0;
  }
  EXPECT_EQ(free, 27);
}

TEST(VectorPolynomial, HasTheTermsOfEquation48) {
  EXPECT_EQ(term_count(0), 1);
  EXPECT_EQ(term_count(4), 35);
  std::vector<double> values(35);
  monomials({2.0, 3.0, 5.0}, 4, values);
  // Complete and each once: the sum of all monomials of (1, x, y, z) of degree at most four.
  double sum = 0.0;
  for (int s = 0; s <= 4; ++s) {
    for (int t = 0; t <= 4 - s; ++t) {
      for (int u = 0; u <= 4 - s - t; ++u) sum += std::pow(2, s) * std::pow(3, t) * std::pow(5, u);
    }
  }
  double total = 0.0;
  for (const double value : values) total += value;
  EXPECT_DOUBLE_EQ(total, sum);
}

// A trilinear function is its own interpolation; outside, the border holds.
TEST(ErrorTable, ReproducesTrilinearFieldsAndHoldsOutside) {
  const auto field = [](const Vec3& p) {
    return PoseError{{1.0 + p.x * p.y * p.z, p.x - 2.0 * p.y, p.z}, {p.x * p.y, p.y * p.z, 3.0}};
  };
  ErrorTable table{.lower = {-1, 0, 2}, .spacing = {0.5, 0.25, 1.0}, .count = {4, 5, 3}, .values = {}};
  for (int z = 0; z < 3; ++z) {
    for (int y = 0; y < 5; ++y) {
      for (int x = 0; x < 4; ++x) table.values.push_back(field(table.lower + Vec3(x, y, z) * table.spacing));
    }
  }
  std::mt19937 random{5};
  const Vec3 upper{0.5, 1.0, 4.0};
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = Vec3{-0.25, 0.5, 3.0} + random_vector(random, 3.0);
    const PoseError expected = field(glm::clamp(p, table.lower, upper)), got = table.at(p);
    EXPECT_LT(glm::distance(got.position, expected.position), kRounding);
    EXPECT_LT(glm::distance(got.orientation, expected.orientation), kRounding);
  }
  EXPECT_TRUE(is_finite(table.at(Vec3{NAN}).position));
  EXPECT_TRUE(is_finite(table.at(Vec3{HUGE_VAL, -HUGE_VAL, 0.0}).position));
}

// Ikits 2006, sec. 4.2.2: an error in the fixed frame is the same however the sensor is turned.
TEST(TrackerCorrection, UndoesAnErrorOfTheFixedFrameForEveryOrientation) {
  std::mt19937 random{7};
  const Quat error = rotation_by({0.05, -0.1, 0.2});
  TrackerCorrection correction;
  correction.position = {.degree = 0, .center = {}, .scale = 1.0, .coefficients = {{0.01, 0.02, 0.03}}};
  correction.orientation = {
      .degree = 0, .center = {}, .scale = 1.0, .coefficients = {short_vector_part(error)}};
  for (int i = 0; i < 200; ++i) {
    const TrackerPose actual{random_vector(random, 1.0), rotation_by(random_vector(random, 3.0))};
    const TrackerPose reported{actual.position - Vec3{0.01, 0.02, 0.03},
                               glm::conjugate(error) * actual.orientation};
    const PoseError e = pose_error(actual, reported);
    EXPECT_LT(glm::distance(e.orientation, short_vector_part(error)), kRounding);
    const TrackerPose corrected = correction.corrected(reported);
    EXPECT_LT(glm::distance(corrected.position, actual.position), kRounding);
    EXPECT_LT(angle_of(corrected.orientation * glm::conjugate(actual.orientation)), 1e-7);
  }
}

}  // namespace
}  // namespace palpate::test
