// What a hand picks that points into a scene: the first thing along a ray, what is nearest to the middle of
// an aperture, and planes where there is nothing else.

#include "common/hand/technique/scene_pick.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace palpate {
namespace {

Line line_of(std::initializer_list<Vec3> places) {
  Line line;
  for (const Vec3& x : places) {
    LinePoint point;
    point.position = x;
    line.points.push_back(point);
  }
  return line;
}

Lens ball_lens(const Vec3& center, double radius) {
  Lens lens;
  lens.shape = make_sphere(center, radius);
  return lens;
}

/// Whether that was picked, there, to rounding.
testing::AssertionResult is(const std::optional<Picked>& found, const Picked& expected) {
  if (!found) return testing::AssertionFailure() << "nothing";
  const bool same = found->kind == expected.kind && found->index == expected.index &&
                    glm::distance(found->place, expected.place) < 1e-12;
  if (same) return testing::AssertionSuccess();
  const Vec3& x = found->place;
  return testing::AssertionFailure() << name_of(*found) << " at " << x.x << " " << x.y << " " << x.z;
}

class ScenePick : public testing::Test {
 protected:
  [[nodiscard]] std::optional<Picked> along(const Vec3& from, const Vec3& to, double radius = 0.05) const {
    return pick(scene(), beam_of(Ray{from, glm::normalize(to - from)}, radius));
  }
  [[nodiscard]] std::optional<Picked> through(const Vec3& center, double radius) const {
    return pick(scene(), beam_of(Aperture{kEye, center, radius}));
  }
  [[nodiscard]] PickScene scene() const {
    return {handles_, planes_, lenses_, lines_, {Vec3(-2.0), Vec3(2.0)}};
  }

  const Vec3 kEye{0.0, 0.0, 5.0};
  std::vector<PickBall> handles_{{{0.0, 0.0, -1.0}, 0.2}};
  std::vector<ConvexShape::HalfSpace> planes_{{{0.0, 0.0, 1.0}, 1.5}, {{0.0, 1.0, 0.0}, -1.0}};
  std::vector<Lens> lenses_{ball_lens({1.0, 0.0, 0.0}, 0.5), ball_lens({0.0, 0.0, 0.5}, 0.3)};
  std::vector<Line> lines_{line_of({{-1.0, -2.0, 0.0}, {-1.0, 2.0, 0.0}}),
                           line_of({{-2.0, 0.5, 1.0}, {-0.5, 0.5, 1.0}, {-0.5, 0.5, -2.0}})};
};

TEST_F(ScenePick, TakesTheFirstThingAlongARay) {
  EXPECT_TRUE(is(along(kEye, {0.0, 0.0, 0.0}), {PickKind::kLens, 1, {0.0, 0.0, 0.8}}));
  EXPECT_TRUE(is(along({0.0, 0.0, -4.0}, {0.0, 0.0, 0.0}), {PickKind::kHandle, 0, {0.0, 0.0, -1.2}}))
      << "from behind the handle comes first";
  const auto line = along({-1.0, 0.01, 5.0}, {-1.0, 0.01, 0.0});
  ASSERT_TRUE(line);
  EXPECT_EQ(line->kind, PickKind::kLine);
  EXPECT_EQ(line->index, 0U);
  EXPECT_LT(glm::distance(line->place, {-1.0, 0.01, 0.0}), 1e-12);
  // Lines are thin: past 50 mm there is the plane, which is not met where it stands in nothing's way.
  const auto beside = along({-1.06, 0.01, 5.0}, {-1.06, 0.01, 0.0});
  ASSERT_TRUE(beside);
  EXPECT_EQ(beside->kind, PickKind::kPlane);
  EXPECT_EQ(beside->index, 0U);
  EXPECT_LT(glm::distance(beside->place, {-1.06, 0.01, 1.5}), 1e-12);
  // Within a lens that is entered where the hand is; away from all, nothing.
  EXPECT_TRUE(is(along({1.0, 0.0, 0.0}, {1.0, 0.0, 1.0}), {PickKind::kLens, 0, {1.0, 0.0, 0.0}}));
  EXPECT_FALSE(along({3.0, 3.0, 0.0}, {4.0, 3.0, 0.0}));
  // A plane that is switched off is counted and not met.
  planes_[0].outward = Vec3{0.0};
  EXPECT_FALSE(along({0.5, 1.9, 5.0}, {0.5, 1.9, 0.0}));
}

TEST_F(ScenePick, AnAperturePicksWhatIsNearestToItsMiddle) {
  // The handle lies behind a lens: handles come first.
  EXPECT_TRUE(is(through({0.0, 0.0, 4.0}, 0.1), {PickKind::kHandle, 0, {0.0, 0.0, -1.0}}));
  handles_.clear();
  EXPECT_TRUE(is(through({0.0, 0.0, 4.0}, 0.1), {PickKind::kLens, 1, {0.0, 0.0, 0.5}}));
  EXPECT_EQ(through({0.19, 0.0, 4.0}, 0.01)->index, 0U) << "a lens that the axis pierces";
  const auto line = through({-0.21, 0.01, 4.0}, 0.05);
  ASSERT_TRUE(line);
  EXPECT_EQ(line->kind, PickKind::kLine);
  EXPECT_EQ(line->index, 0U);
  EXPECT_FALSE(through({-0.4, -0.8, 4.0}, 0.01)) << "wide of all";
}

// Exact for a line's nearest point: no point of it has a smaller angle.
TEST_F(ScenePick, FindsThePointOfALineThatIsNearestInAngle) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const auto vector = [&] { return Vec3(any(random), any(random), any(random)); };
  handles_.clear();
  lenses_.clear();
  planes_.clear();
  int found = 0;
  for (int run = 0; run < 300; ++run) {
    const Vec3 eye = 3.0 * vector(), center = eye + vector(), a = 2.0 * vector(), b = 2.0 * vector();
    lines_ = {line_of({a, b})};
    const double spread = 0.4;
    const PickBeam beam = beam_of(Aperture{eye, center, spread * glm::distance(eye, center)});
    const auto angle = [&](const Vec3& x) {
      return std::acos(glm::dot(glm::normalize(x - eye), beam.direction));
    };
    double least = HUGE_VAL;
    for (int i = 0; i <= 1000; ++i) least = std::min(least, angle(glm::mix(a, b, i / 1000.0)));
    const auto picked = pick(scene(), beam);
    if (least < std::atan(spread) - 1e-3) {
      ASSERT_TRUE(picked) << run;
      EXPECT_LE(angle(picked->place), least + 1e-7);
      ++found;
    }
    if (least > std::atan(spread) + 1e-3) {
      EXPECT_FALSE(picked) << run;
    }
  }
  EXPECT_GT(found, 20);
}

TEST_F(ScenePick, IsSpelledAsARayOrAnAperture) {
  const PickBeam ray = parse_beam("ray:1,2,3,0,0,-2", 0.5, "--pick");
  EXPECT_EQ(ray.origin, Vec3(1.0, 2.0, 3.0));
  EXPECT_EQ(ray.direction, Vec3(0.0, 0.0, -1.0));
  EXPECT_EQ(ray.radius, 0.5);
  const PickBeam cone = parse_beam("aperture:0,0,4,0,0,2,0.5", 0.5, "--pick");
  EXPECT_EQ(cone.direction, Vec3(0.0, 0.0, -1.0));
  EXPECT_EQ(cone.spread, 0.25);
  for (const char* wrong : {"", "ray:1,2,3", "ray:1,2,3,0,0,0", "aperture:0,0,4,0,0,4,1",
                            "aperture:0,0,4,0,0,2,0", "ray:1,2,3,0,0,x", "cone:1,2,3,4,5,6"})
    EXPECT_THROW((void)parse_beam(wrong, 0.5, "--pick"), Error) << wrong;
}

}  // namespace
}  // namespace palpate
