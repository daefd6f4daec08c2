// What a gradient table says, and how well it determines tensors: closed forms of evenly spread directions.

#include "common/field/tensor/gradient_choice.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

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
  const ChosenGradients chosen = choose_gradients(stated);
  EXPECT_EQ(chosen.volumes, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6}));
  ASSERT_EQ(chosen.notes.size(), 1U);
  EXPECT_NE(chosen.notes[0].find("volumes 7, 8 (counted from 0)"), std::string::npos) << chosen.notes[0];
  // GE states the b-value of the shell for its unweighted volumes, too.
  stated.weightings[0] = 1000.0;
  const ChosenGradients ge = choose_gradients(stated);
  EXPECT_EQ(ge.volumes.size(), 9U);
  for (const std::size_t i : {0U, 7U, 8U}) EXPECT_EQ(ge.table.weightings[i], 0.0);
}

}  // namespace
}  // namespace palpate::test
