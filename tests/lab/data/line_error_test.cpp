#include "lab/data/line_error.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

/// A straight line along x with points every `step` up to `length`, `aside` of the axis at its end.
Line straight(std::uint32_t seed, double step, double length, double aside, End end = End::kLeftDomain) {
  Line line{.end = end, .seed = seed};
  for (int i = 0; i * step <= length + 1e-12; ++i) {
    const double s = i * step;
    line.points.push_back({.position = {s, aside * s / length, 0.0}, .arc = s, .error = 0.5 * aside + 1e-16});
  }
  return line;
}

TEST(LineDistance, IsTheLargestAtEqualArcLengths) {
  EXPECT_DOUBLE_EQ(line_distance(straight(0, 0.25, 4.0, 0.1), straight(0, 0.5, 4.0, 0.0), 1.0, true), 0.1);
  // Without the ends, and with points of the reference at every second multiple only.
  EXPECT_DOUBLE_EQ(line_distance(straight(0, 0.25, 4.0, 0.1), straight(0, 3.0, 3.0, 0.0), 1.0, false), 0.075);
}

// The same curve, passed through late: no distance between the curves, but one at equal arc length.
TEST(LineDistance, CountsBeingLateOnTheRightCurve) {
  Line late = straight(0, 1.0, 4.0, 0.0);
  for (LinePoint& p : late.points) p.position.x *= 0.9;
  EXPECT_NEAR(line_distance(late, straight(0, 1.0, 4.0, 0.0), 1.0, true), 0.4, 1e-12);
}

TEST(LineDistance, IsNotANumberWhereNothingIsCommon) {
  EXPECT_TRUE(std::isnan(line_distance(Line{}, straight(0, 1.0, 4.0, 0.0), 1.0, true)));
  EXPECT_TRUE(std::isnan(line_distance(straight(0, 0.1, 0.5, 0.1), straight(0, 1.0, 4.0, 0.0), 1.0, false)));
}

TEST(CompareLines, GivesQuantilesOfTheDiagonal) {
  std::vector<Line> lines;
  std::vector<Line> reference;
  for (std::uint32_t s = 0; s < 100; ++s) {
    lines.push_back(straight(s, 1.0, 4.0, 0.01 * (s + 1)));
    reference.push_back(straight(99 - s, 1.0, 4.0, 0.0));  // matched by seed, not by order
  }
  const LineComparison c = compare_lines(lines, reference, 1.0, 2.0);
  EXPECT_EQ(c.compared, 100U);
  EXPECT_NEAR(c.median, 0.25, 1e-12);
  EXPECT_NEAR(c.p95, 0.475, 1e-12);
  EXPECT_NEAR(c.max, 0.5, 1e-12);
  EXPECT_EQ(c.covered, 0.0);  // each states half of its error
}

// Of twenty lines one method follows two and gives up on the others in a sink of its own: it had the least error
// of all, of two lines.
TEST(CompareLines, JudgeEveryLineOfTheReference) {
  std::vector<Line> reference, lines;
  for (std::uint32_t s = 0; s < 20; ++s) {
    reference.push_back(straight(s, 1.0, 4.0, 0.0));
    if (s < 2) lines.push_back(straight(s, 1.0, 4.0, 1e-9));
    if (s >= 2 && s < 10) lines.push_back(straight(s, 1.0, 2.0, 0.0, End::kStagnation));
    if (s >= 10 && s < 15) lines.push_back(straight(s, 1.0, 2.0, 0.0, End::kMaxSteps));
  }
  const LineComparison c = compare_lines(lines, reference, 1.0, 100.0);
  EXPECT_EQ(c.judged, 20U);
  EXPECT_EQ(c.compared, 2U);
  EXPECT_EQ(c.elsewhere, 8U);
  EXPECT_EQ(c.unfinished, 5U);
  EXPECT_EQ(c.missing, 5U);
  EXPECT_TRUE(std::isinf(c.p95) && std::isinf(c.median));
  EXPECT_NEAR(c.max, 1e-11, 1e-15);
  EXPECT_LE(c.covered, 0.1);
}

TEST(CompareLines, LeaveOutOnlyWhatEndsInsideOnBothSides) {
  const std::vector<Line> reference{straight(0, 1.0, 4.0, 0.0, End::kStagnation), straight(1, 1.0, 4.0, 0.0),
                                    straight(2, 1.0, 4.0, 0.0, End::kMaxLength),
                                    straight(3, 1.0, 4.0, 0.0, End::kStagnation)};
  // The third ends for another reason, but there; the fourth runs through the sink.
  const std::vector<Line> lines{straight(0, 1.0, 4.0, 9.0, End::kStagnation), straight(1, 1.0, 4.0, 0.1),
                                straight(2, 1.0, 4.0, 0.1), straight(3, 1.0, 6.0, 0.0)};
  const LineComparison c = compare_lines(lines, reference, 1.0, 100.0);
  EXPECT_EQ(c.inside, 1U);
  EXPECT_EQ(c.judged, 3U);
  EXPECT_EQ(c.compared, 2U);
  EXPECT_EQ(c.elsewhere, 1U);
  EXPECT_NEAR(c.max, 0.001, 1e-12);
  // Any row can be made again from its lines.
  std::size_t compared = 0;
  for (const LineJudgement& line : c.lines) compared += line.meeting == Meeting::kCompared ? 1 : 0;
  EXPECT_EQ(compared, c.compared);
}

// One stops a little before the border, one far from it, both as if they had left; and they state nothing.
TEST(CompareLines, LeavesEndsOfOtherProgramsAlone) {
  const std::vector<Line> reference{straight(0, 0.5, 4.0, 0.0), straight(1, 0.5, 4.0, 0.0)};
  std::vector<Line> lines{straight(0, 0.5, 3.5, 0.0), straight(1, 0.5, 2.0, 0.0)};
  for (Line& line : lines) {
    for (LinePoint& p : line.points) p.error = std::nan("");
  }
  const LineComparison c = compare_lines(lines, reference, 1.0, 2.0, false);
  EXPECT_EQ(c.compared, 1U);
  EXPECT_EQ(c.elsewhere, 1U);
  EXPECT_EQ(c.max, 0.0);
  EXPECT_TRUE(std::isnan(c.covered));
  // A program that goes on to the border has its ends compared.
  EXPECT_EQ(compare_lines(lines, reference, 1.0, 2.0).max, 1.0);
}

TEST(CompareLines, HasNoErrorWhereNothingIsCompared) {
  const LineComparison c = compare_lines({}, {}, 1.0, 1.0);
  EXPECT_EQ(c.compared, 0U);
  EXPECT_TRUE(std::isnan(c.p95));
}

// A limit cycle of radius 0.01 in a domain of diagonal 1, followed for two diagonals.
TEST(EndsInside, FindsLinesThatWindUp) {
  Line cycle{.end = End::kMaxLength};
  for (int i = 0; i <= 2000; ++i) {
    const double s = 0.001 * i;
    cycle.points.push_back(
        {.position = {0.01 * std::cos(s / 0.01), 0.01 * std::sin(s / 0.01), 0.0}, .arc = s});
  }
  EXPECT_TRUE(ends_inside(cycle, 1.0));
  EXPECT_FALSE(ends_inside(straight(0, 0.01, 2.0, 0.0, End::kMaxLength), 1.0));
  EXPECT_FALSE(ends_inside(straight(0, 0.001, 0.02, 0.0), 1.0));  // short, but it left
}

}  // namespace
}  // namespace palpate::test
