// What a gradient table says, and how well it determines tensors: closed forms of evenly spread directions.

#include "common/field/tensor/gradient_choice.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace palpate::test {
namespace {

/// One unweighted volume, and the six axes of an icosahedron: their moments up to the fifth order are those of
/// the sphere.
GradientTable icosahedron(double b = 1000.0) {
  const double phi = 0.5 * (1.0 + std::sqrt(5.0));
  GradientTable table{{0.0}, {Vec3{0.0}}};
  for (const Vec3& g : {Vec3{1, phi, 0}, Vec3{-1, phi, 0}, Vec3{0, 1, phi}, Vec3{0, -1, phi}, Vec3{phi, 0, 1},
                        Vec3{phi, 0, -1}}) {
    table.weightings.push_back(b);
    table.directions.push_back(glm::normalize(g));
  }
  return table;
}

TEST(TableQuality, OfEvenlySpreadDirectionsIsKnown) {
  const TableQuality quality = quality_of(icosahedron());
  EXPECT_NEAR(quality.condition, std::sqrt(2.5), 1e-12);
  for (const double gain : quality.noise_gain) EXPECT_NEAR(gain, 1.0, 1e-9);
  EXPECT_EQ(shells_text(shells_of(icosahedron())), "b 0: 1 volume; b 1000: 6 volumes in 6 directions");
}

// Two directions 0.2 apart: values of another program, by Jacobi's method and Gauss and Jordan's.
TEST(TableQuality, IsThatOfAnotherProgramWhereTwoDirectionsNearlyAgree) {
  GradientTable table = icosahedron();
  table.directions[2] = glm::normalize(table.directions[1] + 0.2 * Vec3{0.0, 0.0, 1.0});
  const TableQuality quality = quality_of(table);
  EXPECT_NEAR(quality.condition, 232.9307121949457, 1e-6);
  const std::array<double, 6> gains{10.02214757540036, 103.5229443165838, 1.0, 68.38535338773602, 1.0,
                                    26.11991577318698};
  for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(quality.noise_gain[c], gains[c], 1e-6) << c;
  EXPECT_GT(quality.condition, kMostCondition);
}

TEST(GradientChoice, LeavesOutWeightedVolumesWithoutADirection) {
  GradientTable stated = icosahedron();
  for (int n = 0; n < 2; ++n) {
    stated.weightings.push_back(1000.0);
    stated.directions.emplace_back(0.0);
  }
  const ChosenGradients chosen = choose_gradients(stated, {}, "dwi");
  EXPECT_EQ(chosen.volumes, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6}));
  ASSERT_EQ(chosen.notes.size(), 1U);
  EXPECT_NE(chosen.notes[0].find("volumes 7, 8 (counted from 0)"), std::string::npos) << chosen.notes[0];
  // GE states the b-value of the shell for its unweighted volumes, too.
  stated.weightings[0] = 1000.0;
  const ChosenGradients ge = choose_gradients(stated, {}, "dwi");
  EXPECT_EQ(ge.volumes.size(), 9U);
  for (const std::size_t i : {0U, 7U, 8U}) EXPECT_EQ(ge.table.weightings[i], 0.0);
}

TEST(GradientChoice, ScalesByTheSquaredLengthUnlessToldOtherwise) {
  GradientTable stated = icosahedron(2800.0);
  for (std::size_t i = 1; i < 4; ++i) stated.directions[i] *= std::sqrt(1000.0 / 2800.0);
  const ChosenGradients scaled = choose_gradients(stated, {}, "dwi");
  const std::vector<double> right{0.0, 1000.0, 1000.0, 1000.0, 2800.0, 2800.0, 2800.0};
  for (std::size_t i = 0; i < right.size(); ++i) {
    EXPECT_NEAR(scaled.table.weightings[i], right[i], 1e-9);
    EXPECT_NEAR(glm::length(scaled.table.directions[i]), i > 0 ? 1.0 : 0.0, 1e-12);
  }
  ASSERT_EQ(scaled.notes.size(), 1U);
  EXPECT_NE(scaled.notes[0].find("--bvec-length ignore"), std::string::npos) << scaled.notes[0];
  const ChosenGradients ignored = choose_gradients(stated, {.scale_by_length = false}, "dwi");
  for (std::size_t i = 1; i < right.size(); ++i) EXPECT_EQ(ignored.table.weightings[i], 2800.0);
  ASSERT_EQ(ignored.notes.size(), 1U);
  // Rounding to two places is no length.
  GradientTable rounded = icosahedron();
  for (Vec3& g : rounded.directions) g *= 1.003;
  EXPECT_EQ(choose_gradients(rounded, {}, "dwi").table.weightings[1], 1000.0);
  stated.weightings[1] = 1e300;
  stated.directions[1] = Vec3{1e8, 0.0, 0.0};
  EXPECT_THROW((void)choose_gradients(stated, {}, "dwi"), Error);
}

TEST(GradientChoice, LeavesOutWhatItIsTold) {
  GradientTable stated = icosahedron();
  for (const double b : {2000.0, 2010.0, 3000.0}) {
    stated.weightings.push_back(b);
    stated.directions.emplace_back(1.0, 0.0, 0.0);
  }
  using Volumes = std::vector<std::size_t>;
  const auto taken = [&stated](const GradientChoice& choice) {
    return choose_gradients(stated, choice, "dwi").volumes;
  };
  EXPECT_EQ(taken({.left_out = {1, 3, 9}}), (Volumes{0, 2, 4, 5, 6, 7, 8}));
  EXPECT_EQ(taken({.max_weighting = 2000.0}), (Volumes{0, 1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(taken({.shells = {2000.0}}), (Volumes{0, 7, 8}));
  EXPECT_EQ(taken({.shells = {1000.0, 3000.0}}), (Volumes{0, 1, 2, 3, 4, 5, 6, 9}));
  const ChosenGradients chosen = choose_gradients(stated, {.left_out = {1, 2, 3}}, "dwi");
  ASSERT_EQ(chosen.notes.size(), 1U);
  EXPECT_NE(chosen.notes[0].find("volumes 1 to 3 (counted from 0)"), std::string::npos) << chosen.notes[0];
  EXPECT_THROW((void)taken({.left_out = {10}}), Error);
  try {
    (void)taken({.shells = {500.0}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("b 1000: 6 volumes"), std::string::npos) << error.what();
  }
}

// What counts as unweighted goes by what may stay, not by a shell that is left out.
TEST(GradientChoice, TakesShellsFarBelowTheLargestWeighting) {
  GradientTable stated = icosahedron(800.0);
  for (const double b : {17800.0, 17800.0}) {
    stated.weightings.push_back(b);
    stated.directions.emplace_back(1.0, 0.0, 0.0);
  }
  using Volumes = std::vector<std::size_t>;
  EXPECT_EQ(choose_gradients(stated, {.shells = {800.0}}, "dwi").volumes, (Volumes{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(choose_gradients(stated, {.max_weighting = 900.0}, "dwi").volumes,
            (Volumes{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(choose_gradients(stated, {.max_weighting = 500.0}, "dwi").volumes, (Volumes{0}));
}

TEST(GradientChoice, TakesNoTraceImageAsUnweightedWhereTheUnweightedOneIsLeftOut) {
  GradientTable stated = icosahedron();
  stated.weightings.push_back(1000.0);
  stated.directions.emplace_back(0.0);
  EXPECT_EQ(choose_gradients(stated, {.left_out = {0}}, "dwi").volumes,
            (std::vector<std::size_t>{1, 2, 3, 4, 5, 6}));
}

}  // namespace
}  // namespace palpate::test
