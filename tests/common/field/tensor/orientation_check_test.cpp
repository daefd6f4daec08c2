// The check finds the flip or permutation that was put into a made image, and is silent on a right one.

#include "common/field/tensor/orientation_check.h"

#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/tensor_examples.h"
#include "common/field/tensor/gradient_table.h"
#include "common/field/tensor/tensor_field.h"

namespace palpate::test {
namespace {

struct Made {
  UniformTopology topology;
  std::vector<float> tensors;
};

/// The built-in helix with its tensors turned along the image's axes.
Made helix(const Mat3& turn) {
  static const DataSet image = tensor_example("helix");
  Made made{std::get<UniformTopology>(image.topology), {}};
  const DataArray& array = image.arrays.front();
  for (std::size_t p = 0; p < array.tuples; ++p) {
    const auto d = read_tensor(array, p, TensorOrder::kRows);
    const Mat3 t = turn * Mat3{Vec3{d[0], d[1], d[2]}, Vec3{d[1], d[3], d[4]}, Vec3{d[2], d[4], d[5]}} *
                   glm::transpose(turn);
    for (const double value : {t[0][0], t[1][0], t[2][0], t[1][1], t[2][1], t[2][2]})
      made.tensors.push_back(static_cast<float>(value));
  }
  return made;
}

TEST(AxisTurns, AreTwentyFourAndDifferForDirectionsWithoutSign) {
  std::set<std::string> words;
  for (const AxisTurn& turn : axis_turns()) words.insert(turn.text());
  EXPECT_EQ(words.size(), 24U);
  EXPECT_TRUE(axis_turns().front().is_identity());
  const AxisTurn turn{{1, 0, 2}, {false, false, true}};
  EXPECT_EQ(turn.text(), "--permute jik --flip k");
  EXPECT_EQ(turn.matrix() * Vec3(1.0, 2.0, 3.0), Vec3(2.0, 1.0, -3.0));
}

TEST(OrientationCheck, FindsTheWayBackFromWrongTurns) {
  const std::vector<AxisTurn> turns = axis_turns();
  for (const std::size_t t : {0U, 1U, 3U, 5U, 11U, 17U, 22U}) {
    const AxisTurn& wrong = turns[t];
    const Made made = helix(wrong.matrix());
    const OrientationVerdict verdict =
        check_orientation(DirectionMap(made.tensors, made.topology, 2), made.topology, {}, 2);
    EXPECT_EQ(verdict.suspicious, !wrong.is_identity()) << wrong.text() << " gain " << verdict.gain;
    EXPECT_TRUE(verdict.judged) << wrong.text();
    if (!verdict.suspicious) continue;
    // Up to the sign, both turns together change nothing.
    const Mat3 both = verdict.best.turn.matrix() * wrong.matrix();
    EXPECT_TRUE(both == Mat3{1.0} || both == Mat3{-1.0})
        << wrong.text() << " is answered by " << verdict.advice << ", gain " << verdict.gain;
  }
}

// A table that was turned by a few degrees, which no flip mends, is not advised away in silence.
TEST(OrientationCheck, SaysThatARotationIsLeft) {
  const double c = std::cos(0.4), s = std::sin(0.4);
  const Mat3 rotation{Vec3{c, s, 0.0}, Vec3{-s, c, 0.0}, Vec3{0.0, 0.0, 1.0}};
  const AxisTurn flip{{0, 1, 2}, {false, false, true}};
  const Made flipped = helix(flip.matrix()), both = helix(rotation * flip.matrix());
  const OrientationVerdict mended =
      check_orientation(DirectionMap(flipped.tensors, flipped.topology, 2), flipped.topology, {}, 2);
  EXPECT_EQ(mended.advice, "--flip k");
  EXPECT_FALSE(mended.rotated);
  const OrientationVerdict left =
      check_orientation(DirectionMap(both.tensors, both.topology, 2), both.topology, {}, 2);
  EXPECT_TRUE(left.suspicious);
  EXPECT_TRUE(left.rotated) << left.advice;
}

TEST(DirectionMap, ScoresAlikeForAnyNumberOfThreads) {
  const Made made = helix(Mat3{1.0});
  const std::vector<Mat3> turns{Mat3{1.0}, axis_turns()[3].matrix()};
  const DirectionMap one(made.tensors, made.topology, 1), four(made.tensors, made.topology, 4);
  EXPECT_EQ(one.coherence(turns, 1), four.coherence(turns, 4));
  EXPECT_GT(one.size(), 200U);
}

TEST(ImageAxes, AreTheNearestDirectionsAndFslTurnsTheFirstOfRightHandedOnes) {
  const Mat3 axes{Vec3{2.0, 0.0, 0.0}, Vec3{0.0, 3.0, 0.0}, Vec3{0.0, 0.0, 4.0}};
  EXPECT_EQ(image_axes(axes), Mat3{1.0});
  EXPECT_EQ(fsl_axes(axes)[0], Vec3(-1.0, 0.0, 0.0));
  Mat3 left = axes;
  left[0] = -left[0];
  EXPECT_EQ(fsl_axes(left), image_axes(left));
  const Mat3 sheared{Vec3{2.0, 0.0, 0.0}, Vec3{0.5, 3.0, 0.0}, Vec3{0.0, 0.4, 4.0}};
  const Mat3 r = image_axes(sheared);
  const Mat3 product = glm::transpose(r) * r;
  for (int c = 0; c < 3; ++c) {
    for (int row = 0; row < 3; ++row) EXPECT_NEAR(product[c][row], c == row ? 1.0 : 0.0, 1e-14);
    EXPECT_GT(glm::dot(glm::normalize(sheared[c]), r[c]), 0.99);
  }
}

}  // namespace
}  // namespace palpate::test
