// Tracts drawn by hand: where points lie, what is kept of each, and what is saved.

#include "common/hand/drawn/drawn_tract.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "common/field/analytic/tensor_examples.h"
#include "common/hand/drawn/drawn_lines.h"
#include "common/load/trk_header.h"
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
  EXPECT_EQ(pen.take().size(), 2U);
  EXPECT_TRUE(pen.tracts().empty());
}

/// A straight stroke of points 1 mm apart along x.
void draw(TractPen& pen, double from, double to, double time) {
  const double sign = to > from ? 1.0 : -1.0;
  for (long n = 0; n <= std::lround(std::abs(to - from)); ++n) {
    pen.add(time + 0.1 * static_cast<double>(n), {from + sign * static_cast<double>(n), 0.0, 0.0},
            0.1 * static_cast<double>(n));
  }
  pen.let_go();
}

TEST(TractPen, AStrokeGoesOnFromEitherEnd) {
  TractPen pen(planar(), 0.1, 0.5);
  draw(pen, 0.0, 5.0, 0.0);
  draw(pen, 5.2, 9.2, 10.0);
  ASSERT_EQ(pen.tracts().size(), 1U);
  draw(pen, -0.2, -4.2, 20.0);
  ASSERT_EQ(pen.tracts().size(), 1U);
  const DrawnTract& tract = pen.tracts().front();
  ASSERT_EQ(tract.line.points.size(), 16U);
  ASSERT_EQ(tract.forces.size(), 16U);
  ASSERT_EQ(tract.measures.size(), 16U);
  // What was drawn from its first point stands before it; arc and time count from the new one.
  for (std::size_t i = 0; i < 16; ++i) {
    const LinePoint& point = tract.line.points[i];
    EXPECT_NEAR(point.arc, point.position.x + 4.2, 1e-12) << i;
    if (i > 0) {
      EXPECT_GE(point.time, tract.line.points[i - 1].time - 1e-12) << i;
    }
  }
  EXPECT_NEAR(tract.forces.front(), 0.4, 1e-12) << "the force stays with its point";
  draw(pen, 20.0, 25.0, 30.0);
  EXPECT_EQ(pen.tracts().size(), 2U) << "too far away to go on";
  draw(pen, 9.2, 12.2, 40.0);
  ASSERT_EQ(pen.tracts().size(), 2U);
  EXPECT_EQ(pen.tracts().front().line.points.size(), 19U) << "tracts keep their order";
}

/// The largest angle between pieces of a line that follow each other [degrees].
double sharpest_turn(const Line& line) {
  double least = 1.0;
  for (std::size_t i = 2; i < line.points.size(); ++i) {
    const Vec3 a = line.points[i - 1].position - line.points[i - 2].position;
    const Vec3 b = line.points[i].position - line.points[i - 1].position;
    least = std::min(least, glm::dot(a, b) / (glm::length(a) * glm::length(b)));
  }
  return std::acos(least) * 180.0 / 3.14159265358979;
}

// A hand that begins beside the end, behind it or ahead of it, at either end.
TEST(TractPen, AStrokeGoesOnWithoutAKink) {
  for (const bool at_front : {false, true}) {
    for (const double behind : {-0.4, 0.0, 0.4}) {
      for (const double aside : {-0.6, 0.0, 0.3}) {
        TractPen pen(planar(), 0.1, 1.0);
        draw(pen, 0.0, 8.0, 0.0);
        const double sign = at_front ? -1.0 : 1.0;
        for (int n = 0; n < 200; ++n)
          pen.add(20.0 + 0.01 * n, {(at_front ? 0.0 : 8.0) + sign * (0.05 * n - behind), aside, 0.0}, 0.0);
        pen.let_go();
        ASSERT_EQ(pen.tracts().size(), 1U);
        const Line& line = pen.tracts().front().line;
        EXPECT_GT(line.points.back().arc, 15.0);
        EXPECT_LT(sharpest_turn(line), 15.0) << at_front << ' ' << behind << ' ' << aside;
        EXPECT_EQ(line.points.front().position.x < 0.0, at_front);
      }
    }
  }
}

TEST(TractPen, AStrokeMayTurnOffFromAnEnd) {
  TractPen pen(planar(), 0.1, 1.0);
  draw(pen, 0.0, 8.0, 0.0);
  for (int n = 0; n < 100; ++n) pen.add(20.0 + 0.01 * n, {8.0, 0.1 * n, 0.0}, 0.0);
  pen.let_go();
  ASSERT_EQ(pen.tracts().size(), 1U);
  EXPECT_GT(pen.tracts().front().line.points.back().position.y, 9.5);
}

TEST(TractPen, AStrokeReplacesWhatEarlierHandsDrew) {
  TractPen pen(planar(), 0.1, 0.5);
  pen.use(StrokeUse::kReplace);
  draw(pen, 0.0, 5.0, 0.0);
  draw(pen, 10.0, 13.0, 10.0);
  ASSERT_EQ(pen.tracts().size(), 1U);
  EXPECT_EQ(pen.tracts()[0].line.points.front().position.x, 10.0);
  // One hand's strokes do not replace each other.
  pen.add(20.0, {0.0, 0.0, 0.0}, 0.0);
  pen.add(20.1, {1.0, 0.0, 0.0}, 0.0);
  pen.lift();
  pen.add(20.2, {7.0, 0.0, 0.0}, 0.0);
  pen.add(20.3, {8.0, 0.0, 0.0}, 0.0);
  EXPECT_EQ(pen.tracts().size(), 2U);
}

TEST(TractPen, GoesBackToWhatWasDrawnBefore) {
  TractPen pen(planar(), 0.1, 0.5);
  const auto nothing = pen.drawn();
  draw(pen, 0.0, 5.0, 0.0);
  const auto one = pen.drawn();
  EXPECT_NE(one, nothing);
  pen.add(1.0, {0.0, 0.0, 0.0}, 0.0);
  pen.add(1.1, {-1.0, 0.0, 0.0}, 0.0);
  EXPECT_EQ(pen.drawn(), one) << "while it is being drawn";
  pen.let_go();
  draw(pen, -1.0, -5.0, 1.2);
  const auto two = pen.drawn();
  EXPECT_NE(two, one);
  pen.add(2.0, {30.0, 0.0, 0.0}, 0.0);  // a hand that does not move draws nothing
  pen.let_go();
  EXPECT_EQ(pen.drawn(), two);
  pen.add(3.0, {5.0, 0.0, 0.0}, 0.0);  // nor does one that rests on an end
  pen.let_go();
  EXPECT_EQ(pen.drawn(), two);
  EXPECT_EQ(pen.take().size(), 1U);
  EXPECT_TRUE(pen.tracts().empty());
  EXPECT_TRUE(pen.drawn()->empty());
  const auto edits = pen.edits();
  pen.put(two);
  EXPECT_GT(pen.edits(), edits);
  ASSERT_EQ(pen.tracts().size(), 1U);
  EXPECT_EQ(pen.tracts()[0].line.points.size(), 11U);
  pen.put(one);
  ASSERT_EQ(pen.tracts().size(), 1U);
  EXPECT_EQ(pen.tracts()[0].line.points.size(), 6U);
  EXPECT_EQ(pen.tracts()[0].line.points.front().position.x, 0.0);
  pen.put(nothing);
  EXPECT_TRUE(pen.tracts().empty());
}

TEST(TractPen, IsCutBackToWhereTheHandRested) {
  TractPen pen(planar(), 0.1, 0.5);
  const std::uint64_t before = pen.edits();
  for (int n = 0; n < 9; ++n) pen.add(n, {1.0 * n, 0.0, 0.0}, 0.0);
  pen.cut(4);
  EXPECT_GT(pen.edits(), before);
  EXPECT_EQ(pen.tracts()[0].line.points.size(), 4U);
  EXPECT_EQ(pen.tracts()[0].measures.size(), 4U);
  pen.cut(40);
  EXPECT_EQ(pen.tracts()[0].forces.size(), 4U);
  pen.lift();
  pen.cut(2);
  EXPECT_EQ(pen.tracts()[0].forces.size(), 4U) << "another stroke's matter";
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

// What reads a .trk by an image compares its header with that of the image.
TEST(TractPen, SavesTheGridOfItsImage) {
  const test::TempFolder folder;
  const auto field = planar();
  ASSERT_TRUE(field->voxels());
  TractPen pen(field, 0.1);
  pen.add(0.0, {1.0, 2.0, 3.0}, 0.25);
  pen.add(1.0, {2.0, 2.0, 3.0}, 0.5);
  pen.lift();
  (void)save_tracts(folder.path("pen.trk"), pen.tracts(), false);
  DrawnLines kept;
  kept.keep(pen.take());
  kept.save(folder.path("kept.trk"), false);
  for (const char* name : {"pen.trk", "kept.trk"}) {
    const std::string bytes = test::read_file(folder.path(name));
    TrkHeader header;
    std::memcpy(&header, bytes.data(), sizeof header);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int a = static_cast<int>(axis);
      EXPECT_EQ(header.dim[axis], field->voxels()->points[a]) << name;
      EXPECT_EQ(header.vox_to_ras[axis][3], static_cast<float>(field->voxels()->origin[a])) << name;
      EXPECT_EQ(header.vox_to_ras[axis][axis], static_cast<float>(field->voxels()->axes[a][a])) << name;
    }
  }
}

}  // namespace
}  // namespace palpate
