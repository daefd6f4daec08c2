#include "common/trace/line_time.h"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "common/trace/trace.h"
#include "tests/common/trace/helix_field.h"
#include "tests/common/trace/linear_fields.h"

namespace palpate::test {
namespace {

using Side = GrowingLine::Side;

struct TimedLine {
  TimedLine(std::shared_ptr<const VectorField> flow, const Vec3& seed, double max_gap = 1e-8)
      : field(std::move(flow)),
        factory(*field, default_integrator(*field), {.tolerance = 1e-10, .rest_distance = 1e-6}, 1),
        line(*field, factory, {.max_length = 4.0, .max_gap = max_gap}) {
    EXPECT_TRUE(line.start(field->frame().local_from_data(seed)));
    for (const Side side : {Side::kDownstream, Side::kUpstream}) {
      while (!line.end(side)) line.grow(side);
    }
  }

  /// Calls `check(piece, arc)` at many places.
  template <class Check>
  void at_places(const Check& check) const {
    for (int i = line.first(); i < line.last(); ++i) {
      for (int k = 0; k <= 10; ++k) {
        check(i, line.node(i).arc + (line.node(i + 1).arc - line.node(i).arc) * k / 10);
      }
    }
  }

  std::shared_ptr<const VectorField> field;
  WalkFactory factory;
  GrowingLine line;
};

TEST(LineTime, IsTheAngleOfARotation) {
  const Helix helix{{1.0, 0.0, 0.0}, 0.2};
  const TimedLine timed(helix_flow(0.2), helix.seed);
  timed.at_places([&](int piece, double arc) {
    const double time = time_at(timed.line, piece, arc);
    EXPECT_NEAR(time, arc / helix.speed(), 1e-8);
    const Vec3 x = timed.line.piece(piece).at(arc - timed.line.node(piece).arc);
    EXPECT_NEAR(std::remainder(time - std::atan2(x.y, x.x), 2.0 * std::numbers::pi), 0.0, 1e-7);
  });
}

// v = x along the x axis: x = x_0 e^t, so t = log(1 + s / x_0) at the arc s.
TEST(LineTime, IsALogarithmWhereTheSpeedGrowsWithTheWay) {
  const TimedLine timed(
      make_vector_field(std::make_shared<const LinearField>(rows(1, 0, 0, 0, 0, 0, 0, 0, 0), Vec3{0.0})),
      {0.25, 0.0, 0.0});
  ASSERT_GT(timed.line.last() - timed.line.first(), 4);
  double straight = 0.0;
  timed.at_places([&](int piece, double arc) {
    const LineNode &a = timed.line.node(piece), &b = timed.line.node(piece + 1);
    if (a.position.x < 0.05) return;  // each piece is a large part of the distance from the fixed point
    const double exact = std::log1p(arc / 0.25);
    // Times are cubic between nodes: the remainder is h^4 / 384 of the fourth derivative, 6 / x^4.
    const double h = b.arc - a.arc, x = std::min(a.position.x, b.position.x);
    EXPECT_NEAR(time_at(timed.line, piece, arc), exact, 6.0 * std::pow(h / x, 4) / 384.0 + 1e-9);
    const double u = (arc - a.arc) / h;
    straight = std::max(straight, std::abs(a.time + u * (b.time - a.time) - exact));
  });
  EXPECT_GT(straight, 3e-5) << "straight lines between the nodes would not do";
}

TEST(LineTime, RisesAllAlongAndIsFoundAgain) {
  const TimedLine timed(on_tetrahedra(rows(-0.5, -1, 0, 1, -0.5, 0, 0, 0, 1), Vec3{0.0}, 5, 0.2, 3),
                        {0.4, 0.1, 0.05});
  double before = -HUGE_VAL;
  timed.at_places([&](int piece, double arc) {
    const double time = time_at(timed.line, piece, arc);
    EXPECT_GE(time, before - 4e-16) << "but for rounding";
    before = time;
    const TimePlace place = find_time(timed.line, 0, time, 100'000);
    ASSERT_TRUE(place.found);
    EXPECT_NEAR(place.arc, arc, 1e-11);
    EXPECT_LE(timed.line.node(place.piece).arc, place.arc);
    EXPECT_GE(timed.line.node(place.piece + 1).arc, place.arc);
  });
}

TEST(LineTime, SaysHowFarItWentAndWhereItEnds) {
  const TimedLine timed(helix_flow(0.2), {1.0, 0.0, 0.0});
  const GrowingLine& line = timed.line;
  const int first = line.first(), last = line.last();
  ASSERT_GT(last, 6);
  const double time = 0.5 * (line.node(5).time + line.node(6).time);
  const TimePlace place = find_time(line, 0, time, 100);
  EXPECT_TRUE(place.found);
  EXPECT_EQ(place.piece, 5);
  EXPECT_EQ(place.pieces, 5);
  EXPECT_FALSE(find_time(line, 0, time, 5).found) << "no more pieces than allowed";
  EXPECT_TRUE(find_time(line, first, time, last - first).found);
  EXPECT_FALSE(find_time(line, 0, line.node(last).time + 1e-3, 100'000).found);
  EXPECT_FALSE(find_time(line, 0, line.node(first).time - 1e-3, 100'000).found);
}

}  // namespace
}  // namespace palpate::test
