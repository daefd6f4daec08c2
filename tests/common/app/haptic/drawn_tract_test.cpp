// Tracts drawn by hand: where points lie, what is kept of each, and what is saved.

#include "common/app/haptic/drawn_tract.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/field/analytic/tensor_examples.h"
#include "common/field/analytic/tensor_sampled.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

std::shared_ptr<const TensorField> planar() {
  return make_tensor_field(sample_tensors(*tensor_formula("planar"), Index3{41}, 0.0),
                           {.array = kTensorArray}, "planar");
}

TEST(TractPen, TakesStepsTogetherThatAreCloserThanTheSpacing) {
  TractPen pen(planar(), 0.5);
  // 0.1 mm a step; the force is largest between points.
  for (int n = 0; n <= 100; ++n) pen.add(10.0 + 0.001 * n, {0.1 * n, 0.0, 0.0}, n == 33 ? 3.0 : 1.0);
  ASSERT_EQ(pen.tracts().size(), 1U);
  const DrawnTract& tract = pen.tracts().front();
  ASSERT_GE(tract.line.points.size(), 17U);
  ASSERT_LE(tract.line.points.size(), 21U);
  ASSERT_EQ(tract.forces.size(), tract.line.points.size());
  ASSERT_EQ(tract.measures.size(), tract.line.points.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < tract.line.points.size(); ++i) {
    const LinePoint& point = tract.line.points[i];
    EXPECT_NEAR(point.arc, point.position.x, 1e-12);
    EXPECT_NEAR(point.time, 0.01 * point.position.x, 1e-12);
    EXPECT_NEAR(point.speed, 100.0, 1e-6);
    EXPECT_GT(point.error, 0.0);
    EXPECT_NEAR(tract.measures[i].parts.planar, 1.4 / 2.3, 0.01);
    EXPECT_NEAR(tract.measures[i].parts.linear, 0.0, 0.01);
    largest = std::max(largest, tract.forces[i]);
  }
  EXPECT_EQ(largest, 3.0);
}

TEST(TractPen, BeginsAnotherTractWhenItWasLifted) {
  TractPen pen(planar(), 0.1);
  pen.lift();
  EXPECT_TRUE(pen.tracts().empty());
  for (int n = 0; n < 5; ++n) pen.add(n, {1.0 * n, 0.0, 0.0}, 0.0);
  pen.lift();
  pen.lift();
  for (int n = 0; n < 3; ++n) pen.add(7.0 + n, {1.0 * n, 1.0, 0.0}, 0.0);
  ASSERT_EQ(pen.tracts().size(), 2U);
  EXPECT_EQ(pen.tracts()[0].line.points.size(), 5U);
  EXPECT_EQ(pen.tracts()[1].line.points.size(), 3U);
  EXPECT_EQ(pen.tracts()[1].line.points.front().time, 0.0);
  EXPECT_EQ(pen.tracts()[1].line.seed, 1U);
  pen.clear();
  EXPECT_TRUE(pen.tracts().empty());
}

TEST(TractPen, SaysWhereThereIsNoTensor) {
  TractPen pen(planar(), 0.1);
  pen.add(0.0, {100.0, 0.0, 0.0}, 1.0);
  EXPECT_TRUE(std::isnan(pen.tracts()[0].measures[0].parts.linear));
  EXPECT_TRUE(std::isnan(pen.tracts()[0].measures[0].fractional_anisotropy));
}

TEST(TractPen, SavesLinesOfTwoPointsAndMoreWithTheirColumns) {
  const test::TempFolder folder;
  TractPen pen(planar(), 0.1);
  pen.add(0.0, {1.0, 2.0, 3.0}, 0.25);
  pen.add(1.0, {2.0, 2.0, 3.0}, 0.5);
  pen.lift();
  pen.add(2.0, {5.0, 2.0, 3.0}, 0.5);
  EXPECT_EQ(save_tracts(folder.path("tract.csv"), pen.tracts(), false), 1U);
  const std::string text = test::read_file(folder.path("tract.csv"));
  EXPECT_NE(text.find(",force,cl,cp,fa\n"), std::string::npos) << text;
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3) << text;
  EXPECT_NE(text.find(",0.25,"), std::string::npos) << text;
}

}  // namespace
}  // namespace palpate
