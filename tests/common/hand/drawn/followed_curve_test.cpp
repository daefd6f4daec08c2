#include "common/hand/drawn/followed_curve.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/common/trace/helix_field.h"

namespace palpate::test {
namespace {

using Side = GrowingLine::Side;
constexpr double kRise = 0.25;

class FollowedCurveTest : public ::testing::Test {
 protected:
  void grow(int pieces) {
    for (int i = 0; i < pieces; ++i) {
      live_->current()->grow(Side::kDownstream);
      live_->current()->grow(Side::kUpstream);
    }
  }
  void start(const Vec3& seed) {
    helix_.seed = seed;
    ASSERT_TRUE(live_->start(seed));
  }
  /// The angle that the flow turns from the seed to `x`, within a turn of `near`.
  [[nodiscard]] double time_of(const Vec3& x) const { return (x.z - helix_.seed.z) / kRise; }

  std::shared_ptr<LiveLine> live_ = std::make_shared<LiveLine>(helix_flow(kRise), 1e-9, 1);
  Helix helix_{{1.0, 0.0, 0.0}, kRise};
  FollowedCurve curve_{live_};
};

TEST_F(FollowedCurveTest, IsNothingWhileNoLineIsFollowed) {
  curve_.update(0.5, LineStyle{});
  EXPECT_EQ(curve_.drawn(), nullptr);
  EXPECT_EQ(curve_.number(), 0U);
  EXPECT_TRUE(curve_.line().points.empty());
  start({1.0, 0.0, 0.0});
  curve_.update(0.5, LineStyle{});
  EXPECT_NE(curve_.drawn(), nullptr);
  EXPECT_NE(curve_.number(), 0U);
  live_->drop();
  curve_.update(0.5, LineStyle{});
  EXPECT_EQ(curve_.drawn(), nullptr);
}

TEST_F(FollowedCurveTest, ItsChordsLeaveTheLineByHalfAMillionthOfTheDiagonal) {
  start({0.8, 0.3, -0.5});
  grow(100);
  curve_.update(0.0, LineStyle{});
  const std::vector<Vec3>& points = curve_.drawn()->points;
  ASSERT_GT(points.size(), 100U);
  double worst = 0.0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    for (const double u : {0.0, 0.25, 0.5, 0.75}) {
      const Vec3 x = points[i] + u * (points[i + 1] - points[i]);
      // The distance from the helix is at most that from its point at the same height.
      worst = std::max(worst, glm::distance(x, helix_.at_time(time_of(x))));
    }
  }
  EXPECT_LE(worst, 5e-7 * live_->field().diagonal());
  EXPECT_GT(worst, 1e-8 * live_->field().diagonal()) << "and are no denser than they need be";
  EXPECT_TRUE(curve_.drawn()->balls.empty());
}

TEST_F(FollowedCurveTest, ItsBallsStandAtEqualTimesAndStayWhileItGrows) {
  constexpr double kInterval = 0.4;
  start({1.0, 0.0, 0.0});
  grow(3);
  curve_.update(kInterval, LineStyle{.color_by = ColorBy::kTime});
  const std::vector<Vec3> before = curve_.drawn()->balls;
  grow(100);
  curve_.update(kInterval, LineStyle{.color_by = ColorBy::kTime});
  const FollowedLine& drawn = *curve_.drawn();
  ASSERT_GT(drawn.balls.size(), before.size());
  ASSERT_EQ(drawn.ball_values.size(), drawn.balls.size());
  for (std::size_t k = 0; k < drawn.balls.size(); ++k) {
    const double turns = time_of(drawn.balls[k]) / kInterval;
    EXPECT_NEAR(turns, std::round(turns), 1e-6);
    EXPECT_LE(glm::distance(drawn.balls[k], helix_.at_time(time_of(drawn.balls[k]))), 1e-6);
    EXPECT_NEAR(drawn.ball_values[k], time_of(drawn.balls[k]), 1e-6);
    if (k > 0) {
      EXPECT_NEAR(time_of(drawn.balls[k]) - time_of(drawn.balls[k - 1]), kInterval, 1e-6);
    }
  }
  for (const Vec3& ball : before) {
    EXPECT_TRUE(std::any_of(drawn.balls.begin(), drawn.balls.end(), [&](const Vec3& x) {
      return glm::distance(x, ball) < 1e-7;
    })) << "a ball has moved";
  }
}

TEST_F(FollowedCurveTest, IsColouredByWhatColoursTheScene) {
  start({1.0, 0.0, 0.0});
  grow(50);
  const auto each = [&](ColorBy by, const auto& expected) {
    curve_.update(0.5, LineStyle{.color_by = by});
    const FollowedLine& drawn = *curve_.drawn();
    ASSERT_EQ(drawn.values.size(), drawn.points.size());
    for (std::size_t i = 0; i < drawn.points.size(); ++i) {
      EXPECT_NEAR(drawn.values[i], expected(time_of(drawn.points[i])), 2e-6);
    }
    EXPECT_EQ(drawn.ball_values.size(), drawn.balls.size());
  };
  each(ColorBy::kSpeed, [&](double) { return helix_.speed(); });
  each(ColorBy::kTime, [](double t) { return t; });
  each(ColorBy::kArc, [&](double t) { return t * helix_.speed(); });
  curve_.update(0.5, LineStyle{.color_by = ColorBy::kError});
  EXPECT_EQ(curve_.drawn()->values.size(), curve_.drawn()->points.size());
  EXPECT_GE(*std::min_element(curve_.drawn()->values.begin(), curve_.drawn()->values.end()), 0.0);
  curve_.update(0.5, LineStyle{.color_by = ColorBy::kDirection});
  EXPECT_TRUE(curve_.drawn()->values.empty()) << "a quantity that it does not carry";
}

// What the lines of the scene do not carry is sampled along this one, too.
TEST_F(FollowedCurveTest, IsColouredByAnArrayOfTheData) {
  const auto array_of = [](double factor) {
    auto array = std::make_shared<LineArray>();
    array->name = "height";
    array->at = [factor](const Vec3& x, CellHint&) { return factor * x.z; };
    return LineStyle{.color_by = ColorBy::kArray, .array = array};
  };
  start({1.0, 0.0, 0.0});
  grow(50);
  const auto expect = [&](double factor) {
    const FollowedLine& drawn = *curve_.last();
    ASSERT_EQ(drawn.values.size(), drawn.points.size());
    ASSERT_EQ(drawn.ball_values.size(), drawn.balls.size());
    for (std::size_t i = 0; i < drawn.points.size(); ++i)
      EXPECT_EQ(drawn.values[i], factor * drawn.points[i].z);
    for (std::size_t i = 0; i < drawn.balls.size(); ++i)
      EXPECT_EQ(drawn.ball_values[i], factor * drawn.balls[i].z);
  };
  curve_.update(0.5, array_of(1.0));
  expect(1.0);
  const std::size_t points = curve_.drawn()->points.size();
  grow(5);
  curve_.update(0.5, array_of(1.0));
  EXPECT_GT(curve_.drawn()->points.size(), points);
  expect(1.0);
  curve_.update(0.5, array_of(3.0));  // another time step
  expect(3.0);

  live_->drop();
  curve_.update(0.5, array_of(-2.0));
  EXPECT_EQ(curve_.drawn(), nullptr);
  expect(-2.0);
  FollowedCurve next(live_, &curve_);  // of another chain
  next.update(0.5, LineStyle{.color_by = ColorBy::kTime});
  ASSERT_TRUE(next.last());
  EXPECT_EQ(next.last()->points.size(), curve_.last()->points.size());
  EXPECT_NEAR(next.last()->values.back(), time_of(next.last()->points.back()), 2e-6);
  next.update(0.5, LineStyle{.color_by = ColorBy::kArray});
  EXPECT_TRUE(next.last()->values.empty()) << "an array that is not known";
  next.forget();
  EXPECT_EQ(next.last(), nullptr);
}

TEST_F(FollowedCurveTest, IsColouredByItsEndWhenThatIsReached) {
  const LineStyle style{.color_by = ColorBy::kTermination};
  start({1.0, 0.0, 0.0});
  grow(2);
  curve_.update(0.0, style);
  EXPECT_TRUE(curve_.drawn()->values.empty()) << "nobody knows yet";
  while (!live_->current()->end(Side::kDownstream)) live_->current()->grow(Side::kDownstream);
  curve_.update(0.0, style);
  const auto end = static_cast<double>(*live_->current()->end(Side::kDownstream));
  EXPECT_EQ(curve_.drawn()->values, std::vector<double>(curve_.drawn()->points.size(), end));
}

TEST_F(FollowedCurveTest, IsAnotherObjectOnlyWhereSomethingHasChanged) {
  start({1.0, 0.0, 0.0});
  grow(5);
  curve_.update(0.5, LineStyle{});
  const auto first = curve_.drawn();
  curve_.update(0.5, LineStyle{});
  EXPECT_EQ(curve_.drawn(), first);
  grow(1);
  curve_.update(0.5, LineStyle{});
  EXPECT_NE(curve_.drawn(), first);
  const std::uint64_t number = curve_.number();
  start({0.5, 0.0, 0.0});
  curve_.update(0.5, LineStyle{});
  EXPECT_NE(curve_.number(), number);
}

TEST_F(FollowedCurveTest, TheWholeLineBeginsAtItsUpstreamEnd) {
  start({1.0, 0.0, 0.0});
  grow(2000);
  curve_.update(0.0, LineStyle{});
  const Line line = curve_.line();
  ASSERT_GT(line.points.size(), 10U);
  EXPECT_EQ(line.points.front().arc, 0.0);
  EXPECT_EQ(line.end, live_->current()->end(Side::kDownstream));
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    const LinePoint& point = line.points[i];
    EXPECT_LE(glm::distance(point.position, helix_.at_time(point.time)), 1e-6);
    EXPECT_NEAR(point.arc, (point.time - line.points.front().time) * helix_.speed(), 1e-6);
    EXPECT_NEAR(point.speed, helix_.speed(), 1e-6);
    EXPECT_GE(point.error, 0.0);
    if (i > 0) {
      EXPECT_GT(point.arc, line.points[i - 1].arc);
    }
  }
  EXPECT_LT(line.points.front().position.z, helix_.seed.z);
  EXPECT_GT(line.points.back().position.z, helix_.seed.z);
}

TEST(FollowedCurveUnits, AreThoseOfTheData) {
  constexpr int kLength = 5, kSpeed = -3;
  const auto live = std::make_shared<LiveLine>(
      make_vector_field(std::make_shared<const HelixField>(kRise), kLength, kSpeed), 1e-9, 1);
  ASSERT_TRUE(live->start({1.0, 0.0, 0.0}));
  for (int i = 0; i < 50; ++i) live->current()->grow(Side::kDownstream);
  FollowedCurve curve(live);
  const Helix helix{{1.0, 0.0, 0.0}, kRise};
  curve.update(0.5 * 0x1p8, LineStyle{.color_by = ColorBy::kArc});
  EXPECT_EQ(curve.drawn()->points.front(), Vec3(32.0, 0.0, 0.0));
  const Vec3 last = curve.drawn()->points.back();
  EXPECT_NEAR(curve.drawn()->values.back(), last.z / kRise * helix.speed(), 1e-4);
  ASSERT_GT(curve.drawn()->balls.size(), 1U);
  EXPECT_NEAR(curve.drawn()->balls[1].z, 32.0 * 0.5 * kRise, 1e-4);
  EXPECT_NEAR(curve.line().points.back().time, last.z / 32.0 / kRise * 0x1p8, 1e-3);
  EXPECT_NEAR(curve.line().points.back().speed, helix.speed() / 8.0, 1e-9);
}

}  // namespace
}  // namespace palpate::test
