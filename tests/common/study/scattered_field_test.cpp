// Figures are those of SciPy 1.10.1, computed apart from this code.
#include "common/study/scattered_field.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

std::vector<ScatteredVector> made_vectors() {
  std::vector<ScatteredVector> out;
  for (int i = 1; i <= 7; ++i) {
    const Vec3 place{std::fmod(0.137 * i * i + 0.21 * i, 1.0), std::fmod(0.071 * i * i + 0.43 * i, 1.0),
                     std::fmod(0.3 * i, 1.0)};
    out.push_back({place, {std::sin(3.0 * i), i, -1.0}});
  }
  return out;
}

// interpolate.Rbf() with the function r^2 (ln r - 1).
TEST(BiharmonicSpline, IsThatOfSciPy) {
  const std::vector<Vec3> places{{0.1, 0.2, 0.0}, {0.5, 0.5, 3.0}, {0.83, 0.31, 0.0}, {1.0, 0.0, 0.0}};
  const std::vector<Vec3> values = biharmonic_spline(made_vectors(), places);
  const double expected[]{-0.38129947730256175, -0.018043173712567473, -0.15020071949061453,
                          -0.5227082888286905};
  for (std::size_t i = 0; i < places.size(); ++i) EXPECT_NEAR(values[i].x, expected[i], 1e-9);
}

// spatial.distance.cdist() to the power of -2.
TEST(InverseDistance, IsThatOfSciPy) {
  const std::vector<Vec3> places{{0.1, 0.2, 0.3}, {0.5, 0.5, 0.5}, {0.83, 0.31, 0.9}};
  const std::vector<Vec3> values = inverse_distance(made_vectors(), places);
  const double expected[]{0.1759046443157019, 0.15519228155270318, -0.06272532386687078};
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_NEAR(values[i].x, expected[i], 1e-9);
    EXPECT_NEAR(values[i].z, -1.0, 1e-15);
  }
}

TEST(ScatteredFields, GoThroughTheirVectors) {
  const std::vector<ScatteredVector> vectors = made_vectors();
  std::vector<Vec3> places;
  for (const ScatteredVector& one : vectors) places.push_back(one.place);
  const std::vector<Vec3> spline = biharmonic_spline(vectors, places),
                          shepard = inverse_distance(vectors, places);
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    EXPECT_LT(glm::distance(spline[i], vectors[i].vector), 1e-9);
    EXPECT_EQ(shepard[i], vectors[i].vector);
  }
}

TEST(GridField, HasItsValuesAtItsPoints) {
  const Box box{{0.0, 1.0, 2.0}, {1.0, 3.0, 5.0}};
  const Index3 n{3, 4, 2};
  const std::vector<Vec3> places = grid_places(n, box);
  ASSERT_EQ(places.size(), 24U);
  EXPECT_EQ(places[1], Vec3(0.5, 1.0, 2.0)) << "x fastest";
  EXPECT_EQ(places.back(), box.upper);
  const auto field = grid_field(n, box, places);
  CellHint hint;
  EXPECT_LT(glm::distance(field->sample({0.3, 2.2, 4.1}, hint).value, Vec3(0.3, 2.2, 4.1)), 1e-12);
}

}  // namespace
}  // namespace palpate::test
