// Edits of tracts against closed forms: what is cut, joined, smoothed, spread anew, kept and dropped.

#include "common/trace/tract/tract_edit.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "common/base/index.h"

namespace palpate::test {
namespace {

void add_line(Tractogram& lines, const std::vector<Vec3>& points) {
  for (const Vec3& x : points) lines.points.emplace_back(x);
  lines.starts.push_back(lines.points.size());
}

/// Two lines along x, at y = 0 and y = 5, with a number of each point (its x) and of each line (its y).
Tractogram two_lines() {
  Tractogram lines;
  add_line(lines, {{0, 0, 0}, {4, 0, 0}, {10, 0, 0}});
  add_line(lines, {{20, 5, 0}, {12, 5, 0}});
  lines.of_points = {{.name = "x", .values = {0, 4, 10, 20, 12}}};
  lines.of_lines = {{.name = "y", .values = {0, 5}}};
  return lines;
}

double length_of(const Tractogram& lines, std::size_t l) {
  double length = 0.0;
  const auto line = lines.line(l);
  for (std::size_t p = 1; p < line.size(); ++p) length += glm::distance(Vec3(line[p - 1]), Vec3(line[p]));
  return length;
}

/// The number of each point is its place on the axis, however it came to be.
void expect_numbers(const Tractogram& lines) {
  ASSERT_EQ(lines.of_points.front().values.size(), lines.points.size());
  ASSERT_EQ(lines.of_lines.front().values.size(), lines.line_count());
  for (std::size_t p = 0; p < lines.points.size(); ++p)
    EXPECT_FLOAT_EQ(lines.of_points.front().values[p], lines.points[p].x);
  for (std::size_t l = 0; l < lines.line_count(); ++l)
    EXPECT_FLOAT_EQ(lines.of_lines.front().values[l], lines.line(l).front().y);
}

TEST(TractEdit, FindsThePlaceNearestToAPointAndToARay) {
  const Tractogram lines = two_lines();
  const auto near = nearest_place(lines, {7.0, 1.0, 0.0});
  ASSERT_TRUE(near);
  EXPECT_EQ(near->line, 0U);
  EXPECT_EQ(near->point, 1U);
  EXPECT_DOUBLE_EQ(near->part, 0.5);
  EXPECT_DOUBLE_EQ(near->distance, 1.0);
  const auto along = place_along_ray(lines, {15.0, 5.3, 100.0}, {0.0, 0.0, -1.0}, 0.5, 0.0);
  ASSERT_TRUE(along);
  EXPECT_EQ(along->line, 1U);
  EXPECT_NEAR(glm::distance(along->place, Vec3(15, 5, 0)), 0.0, 1e-12);
  EXPECT_FALSE(place_along_ray(lines, {15.0, 5.6, 100.0}, {0.0, 0.0, -1.0}, 0.5, 0.0)) << "too far beside it";
  EXPECT_FALSE(place_along_ray(lines, {15.0, 5.0, -100.0}, {0.0, 0.0, -1.0}, 0.5, 0.0)) << "behind the eye";
  EXPECT_FALSE(nearest_place(Tractogram(), Vec3(0.0)));
}

TEST(TractEdit, CutsOneLineAndPartsAllAtAPlane) {
  const Tractogram lines = two_lines();
  const Tractogram cut = cut_line(lines, *nearest_place(lines, {7.0, 0.0, 0.0}));
  ASSERT_EQ(cut.line_count(), 3U);
  EXPECT_DOUBLE_EQ(length_of(cut, 0), 7.0);
  EXPECT_DOUBLE_EQ(length_of(cut, 2), 3.0) << "the second part is the last line";
  EXPECT_EQ(cut.line(0).back(), cut.line(2).front());
  expect_numbers(cut);
  EXPECT_EQ(cut_line(lines, *nearest_place(lines, {-1.0, 0.0, 0.0})).line_count(), 2U) << "at its end";
  const Tractogram parts = part_lines(lines, {.normal = {1.0, 0.0, 0.0}, .offset = 15.0});
  ASSERT_EQ(parts.line_count(), 3U) << "the first line does not cross it";
  EXPECT_DOUBLE_EQ(length_of(parts, 1), 5.0);
  EXPECT_DOUBLE_EQ(length_of(parts, 2), 3.0);
  expect_numbers(parts);
}

TEST(TractEdit, JoinsTheEndsThatAreNearestWhicheverWayLinesAreStored) {
  for (const bool turned : {false, true}) {
    Tractogram lines;
    add_line(lines,
             turned ? std::vector<Vec3>{{10, 0, 0}, {0, 0, 0}} : std::vector<Vec3>{{0, 0, 0}, {10, 0, 0}});
    add_line(lines, {{0, 9, 0}, {1, 9, 0}});
    add_line(lines, {{20, 5, 0}, {12, 0, 0}});
    const Tractogram joined = join_lines(lines, 0, 2);
    ASSERT_EQ(joined.line_count(), 2U);
    const auto line = joined.line(0);
    ASSERT_EQ(line.size(), 4U);
    const std::array<float, 4> x{0, 10, 12, 20};
    for (std::size_t p = 0; p < 4; ++p) EXPECT_EQ(line[p].x, x[p]) << turned;
  }
}

TEST(TractEdit, SpreadsPointsEvenlyAndKeepsEnds) {
  const Tractogram spread = resample_lines(two_lines(), 3.0);
  ASSERT_EQ(spread.line(0).size(), 5U) << "10 mm: four parts of 2.5";
  for (std::size_t p = 0; p < 5; ++p) EXPECT_FLOAT_EQ(spread.line(0)[p].x, 2.5F * static_cast<float>(p));
  EXPECT_EQ(spread.line(1).front(), Vec3f(20, 5, 0));
  EXPECT_EQ(spread.line(1).back(), Vec3f(12, 5, 0));
  expect_numbers(spread);
}

TEST(TractEdit, SmoothsNoiseByTheGaussiansOwnFactorAndLeavesStraightLines) {
  // Of a wave with wave number k a Gaussian leaves exp(-k^2 s^2 / 2).
  constexpr double kWave = 0.8, kDeviation = 2.0, kHeight = 0.05;
  Tractogram wave;
  std::vector<Vec3> points;
  for (int i = 0; i <= 4000; ++i) points.emplace_back(0.025 * i, kHeight * std::sin(kWave * 0.025 * i), 0.0);
  add_line(wave, points);
  const Tractogram smooth = smooth_lines(wave, kDeviation);
  ASSERT_EQ(smooth.points.size(), wave.points.size());
  double most = 0.0;
  for (std::size_t p = 1000; p < 3000; ++p) most = std::max(most, std::abs(double{smooth.points[p].y}));
  const double wanted = kHeight * std::exp(-0.5 * kWave * kWave * kDeviation * kDeviation);
  EXPECT_NEAR(most, wanted, 0.03 * wanted);
  EXPECT_EQ(smooth.points.front(), wave.points.front());
  EXPECT_EQ(smooth.points.back(), wave.points.back());
  const Tractogram straight = two_lines(), same = smooth_lines(straight, 1.0);
  for (std::size_t p = 0; p < straight.points.size(); ++p)
    EXPECT_NEAR(glm::distance(straight.points[p], same.points[p]), 0.0F, 1e-5F) << "points unevenly spread";
}

TEST(TractEdit, KeepsDropsAndCropsByRegionsBetweenPoints) {
  const Tractogram lines = two_lines();
  // No point of the first line lies in the ball: 4 and 10 are its neighbours.
  const TractRegion ball(Sphere{.center = {7.0, 0.0, 0.0}, .radius = 1.0});
  EXPECT_EQ(lines_through(lines, ball, true).line_count(), 1U);
  EXPECT_EQ(lines_through(lines, ball, false).line(0).front(), Vec3f(20, 5, 0));
  const Tractogram inside = cropped_lines(lines, ball);
  ASSERT_EQ(inside.line_count(), 1U);
  EXPECT_NEAR(length_of(inside, 0), 2.0, 2.0 * kRegionStep);
  for (const Vec3f& x : inside.points) EXPECT_TRUE(ball.contains(Vec3(x)));
  const Tractogram twice =
      cropped_lines(lines, TractRegion(HalfSpace{.normal = {-1, 0, 0}, .offset = -13.0}));
  ASSERT_EQ(twice.line_count(), 2U) << "x < 13: all of the first, the end of the second";
  EXPECT_NEAR(length_of(twice, 1), 1.0, kRegionStep);
  expect_numbers(twice);
}

TEST(TractEdit, DeletesByNumberAndKeepsLengths) {
  const Tractogram lines = two_lines();
  const std::array<std::size_t, 2> gone{0, 7};
  const Tractogram rest = delete_lines(lines, gone);
  ASSERT_EQ(rest.line_count(), 1U);
  expect_numbers(rest);
  EXPECT_EQ(lines_of_length(lines, 8.0, 8.0).line(0).front(), Vec3f(20, 5, 0));
  EXPECT_EQ(lines_of_length(lines, 8.5, 100.0).line_count(), 1U);
  EXPECT_EQ(lines_of_length(lines, 0.0, 7.9).line_count(), 0U);
}

TEST(TractEdit, NumbersThatOneSideLacksAreNotMadeUp) {
  Tractogram lines = two_lines(), more;
  add_line(more, {{0, 0, 9}, {1, 0, 9}});
  more.of_lines = {{.name = "weight", .values = {0.5F}}};
  append_lines(more, lines);
  ASSERT_EQ(lines.line_count(), 3U);
  EXPECT_EQ(lines.line(2).front(), Vec3f(0, 0, 9));
  ASSERT_EQ(lines.of_points.size(), 1U);
  EXPECT_TRUE(std::isnan(lines.of_points[0].values[5]));
  ASSERT_EQ(lines.of_lines.size(), 2U);
  EXPECT_TRUE(std::isnan(lines.of_lines[0].values[2]));
  EXPECT_TRUE(std::isnan(lines.of_lines[1].values[0]));
  EXPECT_EQ(lines.of_lines[1].values[2], 0.5F);
}

}  // namespace
}  // namespace palpate::test
