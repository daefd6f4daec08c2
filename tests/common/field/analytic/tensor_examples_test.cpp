#include "common/field/analytic/tensor_examples.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/data_set_check.h"
#include "common/field/tensor/diffusion_measures.h"
#include "common/field/tensor/tensor_field.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

/// Angle between two directions without sign [rad].
double angle(const Vec3& a, const Vec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), std::abs(glm::dot(a, b)));
}

std::shared_ptr<const TensorField> field_of(const DataSet& image) {
  return make_tensor_field(image, {.array = kTensorArray}, image.name);
}

TEST(TensorExamples, AreTheEightThatAreDocumented) {
  std::vector<std::string> names;
  for (const ExampleInfo& info : tensor_examples()) {
    names.push_back(info.name);
    EXPECT_EQ(tensor_formula(info.name)->name(), info.name);
    EXPECT_FALSE(info.summary.empty());
  }
  const std::vector<std::string> expected{"helix",   "straight",  "crossing", "kissing",
                                          "fanning", "isotropic", "planar",   "eigenvalue-crossing"};
  EXPECT_EQ(names, expected);
  try {
    (void)tensor_example("plait");
    FAIL() << "an example that nobody knows";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("eigenvalue-crossing"), std::string::npos);
  }
}

TEST(TensorExamples, HaveEigenvaluesAboveZeroEverywhere) {
  for (const ExampleInfo& info : tensor_examples()) {
    const auto formula = tensor_formula(info.name);
    const Box box = formula->bounds();
    for (int at = 0; at < 11 * 11 * 11; ++at) {
      const Vec3 part = Vec3{at % 11, at / 11 % 11, at / 121} / 10.0;
      const Mat3 d = formula->tensor(box.lower + part * box.size());
      EXPECT_EQ(d, glm::transpose(d)) << info.name;
      EXPECT_GT(symmetric_eigenvalues(d).z, 2e-4) << info.name;
    }
  }
}

TEST(TensorExamples, MainDirectionsAreTheTangentsOfTheCenterLines) {
  int lines = 0;
  for (const ExampleInfo& info : tensor_examples()) {
    const auto formula = tensor_formula(info.name);
    const Box box = formula->bounds();
    for (const CenterLine& line : formula->center_lines()) {
      ++lines;
      for (int at = 0; at <= 200; ++at) {
        const double u = at / 200.0;
        const Vec3 x = line.position(u);
        ASSERT_TRUE(glm::clamp(x, box.lower, box.upper) == x) << info.name << ' ' << u;
        const double before = std::max(u - 1e-6, 0.0);
        const double after = std::min(u + 1e-6, 1.0);
        const Vec3 chord = line.position(after) - line.position(before);
        EXPECT_GT(glm::dot(glm::normalize(chord), line.direction(u)), 1.0 - 1e-9) << info.name << ' ' << u;
        if (info.name == "crossing" && glm::length(x) < 12.0) continue;
        const SymmetricEigen eigen = symmetric_eigen(formula->tensor(x));
        EXPECT_LT(angle(eigen.vectors[0], line.direction(u)), 1e-6) << info.name << ' ' << u;
        EXPECT_GT(anisotropy(eigen.values).linear, 0.5) << info.name << ' ' << u;
      }
    }
  }
  EXPECT_EQ(lines, 1 + 1 + 2 + 2 + 3);
}

TEST(TensorExamples, AreOfTheKindsThatTheirNamesSay) {
  const auto measures = [](const char* name, const Vec3& x) {
    return anisotropy(symmetric_eigenvalues(tensor_formula(name)->tensor(x)));
  };
  EXPECT_NEAR(measures("isotropic", {3.0, -7.0, 11.0}).spherical, 1.0, 1e-12);
  EXPECT_NEAR(measures("planar", {13.0, -7.0, 11.0}).linear, 0.0, 1e-12);
  EXPECT_GT(measures("planar", {13.0, -7.0, 11.0}).planar, 0.5);
  EXPECT_NEAR(measures("crossing", {0.0, 0.0, 0.0}).linear, 0.0, 1e-12);
  EXPECT_GT(measures("crossing", {0.0, 0.0, 0.0}).planar, 0.5);
  EXPECT_NEAR(measures("eigenvalue-crossing", {0.0, 40.0, 5.0}).linear, 0.0, 1e-12);
  EXPECT_NEAR(measures("eigenvalue-crossing", {20.0, -40.0, 5.0}).spherical, 1.0, 1e-12);
  const auto crossing = tensor_formula("eigenvalue-crossing");
  const Vec3 left = symmetric_eigen(crossing->tensor({-1.0, 40.0, 0.0})).vectors[0];
  const Vec3 right = symmetric_eigen(crossing->tensor({1.0, 40.0, 0.0})).vectors[0];
  EXPECT_NEAR(glm::dot(left, right), 0.0, 1e-12);
}

TEST(TensorExamples, ImagesAreWholeBlocksAndTheSameEveryTime) {
  for (const ExampleInfo& info : tensor_examples()) {
    const DataSet image = tensor_example(info.name);
    EXPECT_NO_THROW(check_block(image, 0, 1, info.name));
    EXPECT_TRUE(std::ranges::equal(image.arrays[0].bytes, tensor_example(info.name).arrays[0].bytes));
    EXPECT_EQ(field_of(image)->negative_tensors(), 0U) << info.name;
  }
}

// The noise alone: a field that is the same everywhere, so that the image is its mean and the noise.
TEST(TensorExamples, NoiseHasItsDeviationInEveryDirection) {
  const auto formula = tensor_formula("isotropic");
  constexpr double kNoise = 1e-5;
  const DataSet clean = sample_tensors(*formula, {41, 40, 39}, 0.0);
  const DataSet noisy = sample_tensors(*formula, {41, 40, 39}, kNoise);
  // v^T N v has the deviation kNoise for every unit vector v, if N prefers no direction.
  for (const Vec3& v : {Vec3{1.0, 0.0, 0.0}, Vec3{0.0, 0.6, 0.8}, Vec3{2.0, -1.0, 2.0} / 3.0}) {
    double sum = 0.0;
    double squares = 0.0;
    const std::size_t count = noisy.point_count();
    for (std::size_t at = 0; at < count; ++at) {
      std::array<double, 6> n{};
      for (int c = 0; c < 6; ++c)
        n[static_cast<std::size_t>(c)] = noisy.arrays[0].at(at, c) - clean.arrays[0].at(at, c);
      const double along = v.x * v.x * n[0] + v.y * v.y * n[3] + v.z * v.z * n[5] +
                           2.0 * (v.x * v.y * n[1] + v.x * v.z * n[2] + v.y * v.z * n[4]);
      sum += along;
      squares += along * along;
    }
    const auto total = static_cast<double>(count);
    // Four deviations of the mean, and of the deviation, of that many independent numbers.
    EXPECT_NEAR(sum / total, 0.0, 4.0 * kNoise / std::sqrt(total));
    EXPECT_NEAR(std::sqrt(squares / total), kNoise, 4.0 * kNoise / std::sqrt(2.0 * total));
  }
}

/// Largest distance between the line of main directions from the start of the centre line and the centre
/// line's point at the same height, over two turns [mm]: Runge-Kutta steps of 0.25 mm.
double helix_drift(const TensorField& field, const CenterLine& line) {
  constexpr double kStep = 0.25;
  constexpr double kRise = 24.0;  // a turn
  CellHint hint;
  Vec3 x = line.position(0.0);
  Vec3 last = line.direction(0.0);
  const double bottom = x.z;
  const double top = line.position(1.0).z;
  const auto main_direction = [&](const Vec3& at) {
    const Vec3 e = symmetric_eigen(field.sample(at, hint).value).vectors[0];
    return glm::dot(e, last) < 0.0 ? -e : e;
  };
  double worst = 0.0;
  while (x.z < bottom + 2.0 * kRise) {
    const Vec3 k1 = main_direction(x);
    const Vec3 k2 = main_direction(x + 0.5 * kStep * k1);
    const Vec3 k3 = main_direction(x + 0.5 * kStep * k2);
    const Vec3 k4 = main_direction(x + kStep * k3);
    last = glm::normalize(k1 + 2.0 * k2 + 2.0 * k3 + k4);
    x += kStep * last;
    double nearest = HUGE_VAL;
    // The foot of x lies near the point at its own height.
    for (int at = -50; at <= 50; ++at) {
      const double u = (x.z - bottom) / (top - bottom) + at * 2e-4;
      nearest = std::min(nearest, glm::length(x - line.position(u)));
    }
    worst = std::max(worst, nearest);
    if (worst > 10.0) break;
  }
  return worst;
}

TEST(TensorExamples, HelixIsFollowedWithinAFifthOfAVoxelOverTwoTurns) {
  constexpr double kVoxel = 2.0;
  const auto formula = tensor_formula("helix");
  const auto clean = field_of(sample_tensors(*formula, Index3{41}, 0.0));
  const auto noisy = field_of(tensor_example("helix"));
  const CenterLine line = formula->center_lines().front();
  const double drift = helix_drift(*clean, line);
  const double with_noise = helix_drift(*noisy, line);
  RecordProperty("drift_mm", std::to_string(drift));
  RecordProperty("drift_with_noise_mm", std::to_string(with_noise));
  EXPECT_LT(drift, 0.2 * kVoxel);
  EXPECT_LT(with_noise, 0.2 * kVoxel);
}

}  // namespace
}  // namespace palpate
