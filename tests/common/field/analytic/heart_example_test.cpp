// The built-in hearts, as they are read.
#include "common/field/analytic/heart_example.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/analytic/excitation.h"
#include "common/field/grid/cell_split.h"
#include "tests/support/excitation_front.h"

namespace palpate {
namespace {

TEST(HeartExample, UnknownOnesAreRefusedAndListed) {
  try {
    (void)HeartExample("kidney");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    for (const ExampleInfo& known : heart_examples())
      EXPECT_NE(std::string(error.what()).find(known.name), std::string::npos);
  }
}

TEST(HeartExample, OnlyWhatIsAskedForIsRead) {
  HeartExample heart("ventricle");
  EXPECT_TRUE(heart.times().empty());
  const DataSet read = heart.read({"fibre", "nonsense"}, 0);
  ASSERT_EQ(read.arrays.size(), 1U);
  EXPECT_EQ(read.arrays.front().name, "fibre");
  EXPECT_EQ(HeartExample("wave").arrays().size(), heart.arrays().size() + 2);
}

/// It is computed once.
HeartExample& wave() {
  static HeartExample heart("wave");
  return heart;
}

TEST(HeartExample, TheWaveReachesAllOfTheWallAndItsBeginningRestsAgain) {
  HeartExample& heart = wave();
  const std::size_t last = heart.times().size() - 1;
  const DataSet end = heart.read({"potential", "activation"}, last);
  const DataArray* activation = end.find("activation", Association::kPoint);
  const DataArray* potential = end.find("potential", Association::kPoint);
  ASSERT_TRUE(activation != nullptr && potential != nullptr);
  std::size_t first = 0;
  for (std::size_t p = 0; p < activation->tuples; ++p) {
    ASSERT_TRUE(std::isfinite(activation->at(p))) << p;
    ASSERT_LT(activation->at(p), heart.times().back());
    if (activation->at(p) < activation->at(first)) first = p;
  }
  EXPECT_EQ(activation->at(first), 0.0);
  EXPECT_LT(potential->at(first), -60.0);
  EXPECT_NEAR(heart.read({"potential"}, 0).arrays.front().at(first), 20.0, 1e-4);
  // The wave has passed a place whose time is half of a step's.
  const DataSet middle = heart.read({"potential"}, last / 2);
  for (std::size_t p = 0; p < activation->tuples; p += 97) {
    const double before = activation->at(p) - heart.times()[last / 2];
    const double potential_then = middle.arrays.front().at(p);
    ASSERT_FALSE(before > 5.0 && potential_then > -30.0) << before;
    ASSERT_FALSE(before < -5.0 && before > -50.0 && potential_then < -30.0) << before;
  }
}

/// The speed of the front in every tetrahedron, by the gradient of the activation time, and how much of it is
/// along the fibre.
struct FrontSpeeds {
  std::vector<double> along, across;
};

FrontSpeeds front_speeds(HeartExample& heart) {
  const DataSet data = heart.read({"activation"}, 0);
  const SplitMesh split = split_into_tetrahedra({&data, 1}, "wave");
  std::vector<double> time(split.points.size());
  for (std::size_t p = 0; p < split.point_of_input.size(); ++p)
    time[split.point_of_input[p]] = data.arrays.front().at(p);
  const Ventricle shape;
  FrontSpeeds speeds;
  for (const TetMesh::Tet& tet : split.tets) {
    const Vec3 x0 = split.points[tet[0]];
    const Mat3 edges{split.points[tet[1]] - x0, split.points[tet[2]] - x0, split.points[tet[3]] - x0};
    const Vec3 rise{time[tet[1]] - time[tet[0]], time[tet[2]] - time[tet[0]], time[tet[3]] - time[tet[0]]};
    const Vec3 gradient = rise * glm::inverse(edges);
    const Prolate at = shape.coordinates(x0 + edges * Vec3{0.25});
    // Away from where the front begins, meets itself, and runs into the base.
    if (time[tet[0]] < 40.0 || time[tet[0]] > 140.0 || at.mu < 0.4 || at.mu > 1.7) continue;
    const double part = std::abs(glm::dot(glm::normalize(gradient), shape.fibre(at)));
    if (part > 0.95) speeds.along.push_back(1.0 / glm::length(gradient));
    if (part < 0.15) speeds.across.push_back(1.0 / glm::length(gradient));
  }
  return speeds;
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

// A bar shows the exact ratio (excitation_test.cpp). Here fronts are as wide as the wall, in which fibres
// turn: across the fibres of one layer they are led by other layers.
TEST(HeartExample, ItsFrontRunsAlongFibresAsTheoryHasIt) {
  const FrontSpeeds speeds = front_speeds(wave());
  ASSERT_GT(speeds.along.size(), 100U);
  ASSERT_GT(speeds.across.size(), 100U);
  const ExcitableTissue tissue;
  const double along = median(speeds.along), across = median(speeds.across);
  EXPECT_NEAR(along, test::front_speed(tissue, tissue.d_along), 0.2 * along);
  EXPECT_GT(across, 0.95 * test::front_speed(tissue, tissue.d_across));
  EXPECT_GT(along / across, 1.4);
  EXPECT_LT(along / across, 1.05 * std::sqrt(tissue.d_along / tissue.d_across));
}

}  // namespace
}  // namespace palpate
