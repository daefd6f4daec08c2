#include "common/render/line/line_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/common/render/sample_scenes.h"

namespace palpate {
namespace {

const SceneFrame kUnit{};

TEST(LineGeometry, TangentsBisectTheChords) {
  const LineGeometry g =
      make_line_geometry(std::vector<std::vector<Vec3>>{{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}}}, kUnit);
  ASSERT_EQ(g.vertices.size(), 3U);
  EXPECT_EQ(g.segments, (std::vector<LineSegment>{{0, 1}, {1, 2}}));
  const float s = std::sqrt(0.5F);
  EXPECT_EQ(g.vertices[0].tangent, Vec3f(1, 0, 0));
  EXPECT_NEAR(glm::distance(g.vertices[1].tangent, Vec3f(s, s, 0)), 0.0F, 1e-6F);
  EXPECT_EQ(g.vertices[2].tangent, Vec3f(0, 1, 0));
}

TEST(LineGeometry, DoublePointsAndNanLeaveSegmentsOutAndNothingElse) {
  const double nan = std::nan("");
  const LineGeometry g =
      make_line_geometry(std::vector<std::vector<Vec3>>{{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {2, 0, 0}},
                                                        {},
                                                        {{5, 5, 5}},
                                                        {{0, 1, 0}, {nan, 1, 0}, {2, 1, 0}, {3, 1, 0}}},
                         kUnit);
  EXPECT_EQ(g.vertices.size(), 9U);
  EXPECT_EQ(g.segments, (std::vector<LineSegment>{{0, 1}, {2, 3}, {7, 8}}));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(g.vertices[static_cast<std::size_t>(i)].tangent, Vec3f(1, 0, 0)) << i;
}

TEST(LineGeometry, LineThatTurnsBackHasATangent) {
  const LineGeometry g =
      make_line_geometry(std::vector<std::vector<Vec3>>{{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}}, kUnit);
  EXPECT_EQ(g.vertices[1].tangent, Vec3f(1, 0, 0));
}

TEST(LineGeometry, SegmentsAreSortedFromFarToNear) {
  LineGeometry g = make_line_geometry(
      std::vector<std::vector<Vec3>>{{{0, 0, 3}, {1, 0, 3}}, {{0, 0, 1}, {1, 0, 1}}, {{0, 0, 2}, {1, 0, 2}}},
      kUnit);
  sort_back_to_front(g.segments, g.vertices, {0, 0, 1});
  EXPECT_EQ(g.segments, (std::vector<LineSegment>{{2, 3}, {4, 5}, {0, 1}}));
  sort_back_to_front(g.segments, g.vertices, {0, 0, -1});
  EXPECT_EQ(g.segments, (std::vector<LineSegment>{{0, 1}, {4, 5}, {2, 3}}));
}

// A circle of 1000 points, and how far its points lie from the segments that are left.
TEST(Simplify, MovesTheLineByNoMoreThanTheTolerance) {
  std::vector<Vec3> circle;
  for (int i = 0; i < 1000; ++i) circle.emplace_back(std::cos(0.00628 * i), std::sin(0.00628 * i), 0.0);
  const LineGeometry g = make_line_geometry(std::vector<std::vector<Vec3>>{circle}, kUnit);
  for (const double tolerance : {1e-4, 3e-4, 1e-3}) {
    const auto segments = simplify(g, {}, tolerance);
    EXPECT_LT(segments.size(), 500U);
    EXPECT_EQ(segments.front().first, 0U);
    EXPECT_EQ(segments.back().last, 999U);
    for (std::size_t k = 0; k < segments.size(); ++k) {
      if (k > 0) {
        ASSERT_EQ(segments[k].first, segments[k - 1].last);
      }
      const Vec3 a = circle[segments[k].first], b = circle[segments[k].last];
      for (std::uint32_t i = segments[k].first; i <= segments[k].last; ++i) {
        const Vec3 chord = b - a, offset = circle[i] - a;
        const double t = glm::dot(offset, chord) / glm::dot(chord, chord);
        ASSERT_LE(glm::length(offset - t * chord), tolerance + 1e-6);  // single precision
      }
    }
  }
  EXPECT_EQ(simplify(g, {}, 0.0).size(), 999U);
}

TEST(Simplify, KeepsCornersGapsAndChangesOfColour) {
  std::vector<Vec3> straight;
  for (int i = 0; i < 9; ++i) straight.emplace_back(i, 0.0, 0.0);
  const LineGeometry one = make_line_geometry(std::vector<std::vector<Vec3>>{straight}, kUnit);
  EXPECT_EQ(simplify(one, {}, 1e-3), (std::vector<LineSegment>{{0, 8}}));
  const std::vector<float> step{0, 0, 0, 0, 1, 1, 1, 1, 1};
  EXPECT_EQ(simplify(one, step, 1e-3), (std::vector<LineSegment>{{0, 3}, {3, 4}, {4, 8}}));
  const float nan = std::nanf("");
  const std::vector<float> hole{0, 0, 0, 0, nan, 0, 0, 0, 0};
  EXPECT_EQ(simplify(one, hole, 1e-3), (std::vector<LineSegment>{{0, 3}, {3, 4}, {4, 5}, {5, 8}}));
  const LineGeometry two = make_line_geometry(std::vector<std::vector<Vec3>>{straight, straight}, kUnit);
  EXPECT_EQ(simplify(two, {}, 1e-3), (std::vector<LineSegment>{{0, 8}, {9, 17}}));
  std::vector<Vec3> corner = straight;
  for (int i = 1; i < 9; ++i) corner.emplace_back(8.0, i, 0.0);
  const LineGeometry bent = make_line_geometry(std::vector<std::vector<Vec3>>{corner}, kUnit);
  for (const LineSegment& s : simplify(bent, {}, 1e-3)) EXPECT_TRUE(s.last <= 8 || s.first >= 8);
}

TEST(Simplify, SpansManyPointsOfASmoothLine) {
  std::vector<Vec3> straight;
  for (int i = 0; i <= 500; ++i) straight.emplace_back(i, 0.0, 0.0);
  const LineGeometry g = make_line_geometry(std::vector<std::vector<Vec3>>{straight}, kUnit);
  EXPECT_EQ(simplify(g, {}, 1e-3), (std::vector<LineSegment>{{0, 500}}));
}

// Less detail moves the line farther, and leaves fewer segments, between the same ends.
TEST(JoinSegments, LeavesFewerWhereMoreMayChange) {
  std::vector<Vec3> circle;
  for (int i = 0; i < 1000; ++i) circle.emplace_back(std::cos(0.00628 * i), std::sin(0.00628 * i), 0.0);
  const LineGeometry g = make_line_geometry(std::vector<std::vector<Vec3>>{circle}, kUnit);
  std::vector<LineSegment> segments = simplify(g, {}, 1e-4);
  for (const double distance : {4e-4, 1.6e-3}) {
    const auto joined = join_segments(g.vertices, segments, {}, {.distance = distance, .cosine = 0.9F});
    EXPECT_LT(joined.size(), 0.7 * static_cast<double>(segments.size()));
    EXPECT_EQ(joined.front().first, 0U);
    EXPECT_EQ(joined.back().last, 999U);
    for (std::size_t k = 1; k < joined.size(); ++k) ASSERT_EQ(joined[k].first, joined[k - 1].last);
    segments = joined;
  }
}

TEST(SampleLines, TakesWholeLinesEvenlyAndMoreOfALargerShare) {
  std::vector<LineSegment> segments;
  for (std::uint32_t line = 0; line < 1000; ++line) {
    segments.push_back({10 * line, 10 * line + 1});
    segments.push_back({10 * line + 1, 10 * line + 2});
  }
  EXPECT_EQ(sample_lines(segments, 1.0), segments);
  const auto quarter = sample_lines(segments, 0.25), tenth = sample_lines(segments, 0.1);
  EXPECT_NEAR(static_cast<double>(quarter.size()), 500.0, 10.0);
  int second = 0;  // of a pair of lines, such as both directions from a seed
  for (std::size_t i = 0; i < quarter.size(); i += 2) {
    EXPECT_EQ(quarter[i].last, quarter[i + 1].first);
    second += quarter[i].first / 10 % 2 == 1 ? 1 : 0;
  }
  EXPECT_NEAR(second, 125, 10);
  for (const LineSegment& s : tenth) EXPECT_NE(std::find(quarter.begin(), quarter.end(), s), quarter.end());
}

std::vector<Line> one_line(const std::vector<double>& speeds) {
  Line line;
  for (const double speed : speeds) line.points.push_back({Vec3(0.0), 0.0, 0.0, speed, speed});
  return {line};
}

TEST(ValueRange, LeavesOutliersAndNonsenseAside) {
  std::vector<double> speeds;
  for (int i = 0; i <= 1000; ++i) speeds.push_back(i);
  speeds.push_back(1e9);
  speeds.push_back(std::nan(""));
  speeds.push_back(std::numeric_limits<double>::infinity());
  const ValueRange range = value_range(one_line(speeds), {});
  EXPECT_NEAR(range.lower, 5.0, 1.0);
  EXPECT_NEAR(range.upper, 996.0, 1.0);
}

TEST(ValueRange, DivergingMapsAreCentredAndLogarithmsPositive) {
  LineStyle style;
  style.color_map = ColorMap::kDiverging;
  const ValueRange centred = value_range(one_line({-1.0, 2.0, 4.0}), style);
  EXPECT_EQ(centred.lower, -4.0);
  EXPECT_EQ(centred.upper, 4.0);
  LineStyle errors;
  errors.color_by = ColorBy::kError;
  const ValueRange positive = value_range(one_line({0.0, 1e-9, 1e-3}), errors);
  EXPECT_EQ(positive.lower, 1e-9);
  EXPECT_EQ(positive.upper, 1e-3);
  EXPECT_EQ(value_range({}, {}), ValueRange{});
}

TEST(MapCoordinates, GoFromZeroToOneOverTheRange) {
  EXPECT_EQ(map_coordinates({1.0, 2.0, 3.0, -7.0, 9.0}, {}, {1.0, 3.0}),
            (std::vector<float>{0, 0.5F, 1, 0, 1}));
  EXPECT_EQ(map_coordinates({5.0}, {}, {5.0, 5.0}), (std::vector<float>{0.5F}));
  EXPECT_TRUE(std::isnan(map_coordinates({std::nan("")}, {}, {0.0, 1.0}).front()));
  LineStyle errors;
  errors.color_by = ColorBy::kError;
  const auto decades = map_coordinates({1e-9, 1e-7, 1e-5, 0.0}, errors, {1e-9, 1e-5});
  EXPECT_NEAR(decades[1], 0.5F, 1e-6F);
  EXPECT_EQ(decades[3], 0.0F);
}

TEST(MapCoordinates, ScalingByAPowerOfTwoChangesNothing) {
  const double scale = std::ldexp(1.0, 60);
  std::vector<double> values, scaled;
  for (int i = 0; i < 100; ++i) {
    values.push_back(std::sqrt(i + 1.0));
    scaled.push_back(values.back() * scale);
  }
  EXPECT_EQ(map_coordinates(values, {}, {1.1, 9.7}), map_coordinates(scaled, {}, {1.1 * scale, 9.7 * scale}));
}

TEST(LineValues, ArrayOfTheWrongLengthIsRefused) {
  LineStyle style;
  style.color_by = ColorBy::kArray;
  auto array = std::make_shared<LineArray>();
  array->values = {1.0F, 2.0F};
  style.array = array;
  EXPECT_THROW((void)line_values(one_line({1.0, 2.0, 3.0}), style), Error);
  EXPECT_EQ(line_values(one_line({7.0, 8.0}), style), (std::vector<double>{1.0, 2.0}));
}

TEST(ColorLabel, SaysTheUnitWhereItIsKnown) {
  LineStyle style;
  EXPECT_EQ(color_label(style, {}), "speed");
  EXPECT_EQ(color_label(style, {"m", "s"}), "speed [m/s]");
  style.color_by = ColorBy::kError;
  EXPECT_EQ(color_label(style, {"mm", ""}), "error estimate [mm]");
}

TEST(ColorBy, NamesAreReadBack) {
  for (int i = 0; i < kColorByCount; ++i) {
    const auto by = static_cast<ColorBy>(i);
    EXPECT_EQ(color_by_from_name(name_of(by)), by);
  }
  EXPECT_THROW((void)color_by_from_name("charm"), Error);
}

}  // namespace
}  // namespace palpate
