// A menu in space under a stylus: pointing opens, the button chooses, sliders and knobs go over detents.

#include "common/window/immersive/space_menu.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "common/math/quaternion.h"

namespace palpate {
namespace {

constexpr int kWidth = 3, kTurn = 4;

/// Three entries, the second with two behind it, a slider with detents each 0.25 and a knob each 15 degrees.
SpaceMenu menu() {
  SpaceItem choice{.label = "mode", .id = 2};
  choice.behind = {{.label = "walls", .id = 21}, {.label = "lines", .id = 22}};
  return SpaceMenu({{.label = "undo", .id = 1},
                    choice,
                    {.label = "axes", .id = 5},
                    {.label = "width",
                     .id = kWidth,
                     .kind = SpaceItem::Kind::kSlider,
                     .range = {0.0, 2.0, 0.25},
                     .value = 1.0},
                    {.label = "turn",
                     .id = kTurn,
                     .kind = SpaceItem::Kind::kKnob,
                     .range = {0.0, 360.0, 15.0},
                     .value = 30.0}});
}

/// Points at places of the menu from a hand that stands anywhere before it.
class SpaceMenuTest : public testing::Test {
 protected:
  SpaceMenuTest() { menu_.put(kCorner, axes_, kEntry); }

  [[nodiscard]] Ray ray(double u, double v) const {
    const Vec3 hand{0.4, -0.3, 2.0};
    const Vec3 at = kCorner + kEntry * (u * axes_[0] - v * axes_[1]);
    return {hand, glm::normalize(at - hand)};
  }
  SpaceEvent point(double u, double v, bool button = false) { return menu_.point(ray(u, v), button); }

  const Vec3 kCorner{-0.5, 0.6, 0.1};
  static constexpr double kEntry = 0.05;
  Mat3 axes_{glm::mat3_cast(rotation_by({0.2, -0.3, 0.1}))};
  SpaceMenu menu_ = menu();
};

TEST_F(SpaceMenuTest, ChoosesWhatIsPointedAtWhenTheButtonGoesDown) {
  EXPECT_EQ(point(1.0, 0.5).kind, SpaceEvent::Kind::kNone);
  EXPECT_EQ(menu_.pointed_label(), "undo");
  const SpaceEvent chosen = point(1.0, 0.5, true);
  EXPECT_EQ(chosen.kind, SpaceEvent::Kind::kChosen);
  EXPECT_EQ(chosen.id, 1);
  EXPECT_EQ(point(1.0, 0.5, true).kind, SpaceEvent::Kind::kNone) << "held is chosen once";
  EXPECT_EQ(point(1.0, 2.5, true).kind, SpaceEvent::Kind::kNone) << "led on to another with the button down";
  (void)point(1.0, 2.5);
  EXPECT_EQ(point(1.0, 2.5, true).id, 5);
  (void)point(-1.0, 0.5);
  EXPECT_EQ(menu_.pointed_label(), "");
  EXPECT_TRUE(menu_.meets(ray(1.0, 0.5)));
  EXPECT_FALSE(menu_.meets(ray(-0.1, 0.5)));
  EXPECT_FALSE(menu_.meets({Vec3(0.0, 0.0, 2.0), axes_[0]})) << "along it";
}

TEST_F(SpaceMenuTest, OpensWhatIsBehindAnEntryByPointingAlone) {
  const double second = SpaceMenu::kColumn + 1.0;
  EXPECT_FALSE(menu_.meets(ray(second, 1.5)));
  (void)point(1.0, 1.5);
  EXPECT_TRUE(menu_.meets(ray(second, 1.5)));
  (void)point(second, 2.5);
  EXPECT_EQ(menu_.pointed_label(), "lines");
  EXPECT_EQ(point(second, 2.5, true).id, 22);
  (void)point(second, 2.5);
  // Back to another entry of the first column: the second is gone.
  (void)point(1.0, 0.5);
  EXPECT_FALSE(menu_.meets(ray(second, 2.5)));
  EXPECT_EQ(point(1.0, 1.5, true).kind, SpaceEvent::Kind::kNone)
      << "an entry with more behind it does nothing";
}

TEST_F(SpaceMenuTest, DragsASliderOverItsDetents) {
  const double left = 0.6, length = SpaceMenu::kColumn - 1.2, down = 3.0 + 1.05;
  const auto at = [&](double value) { return left + length * value / 2.0; };
  (void)point(at(1.0), down);
  EXPECT_EQ(point(at(1.0), down, true).kind, SpaceEvent::Kind::kNone);
  EXPECT_TRUE(menu_.held());
  EXPECT_TRUE(menu_.meets({Vec3(0.0), axes_[2]})) << "while it is held the hand is the menu's";
  int detents = 0;
  double last = 1.0;
  for (double asked = 1.0; asked < 1.9; asked += 0.01) {
    const SpaceEvent event = point(at(asked), down + 3.0, true);  // however far beside
    if (event.kind != SpaceEvent::Kind::kSet) continue;
    ++detents;
    EXPECT_EQ(event.id, kWidth);
    EXPECT_NEAR(event.value, last + 0.25, 1e-12);
    EXPECT_NEAR(asked, last + 0.6 * 0.25, 0.0101) << "beyond the middle by a tenth of a step";
    last = event.value;
  }
  EXPECT_EQ(detents, 3);
  (void)point(at(-5.0), down, true);
  EXPECT_EQ(menu_.value(kWidth), 0.0);
  (void)point(at(1.0), down);
  EXPECT_FALSE(menu_.held());
  EXPECT_EQ(menu_.value(kWidth), 0.0);
  menu_.set(kWidth, 1.5);
  EXPECT_EQ(menu_.value(kWidth), 1.5);
}

TEST_F(SpaceMenuTest, TurnsAKnobWithTheHand) {
  const double top = 3.0 + 1.5;
  const auto at = [&](double degrees) {
    const double a = degrees * kDegree;
    return Vec2{1.5 + 0.8 * std::cos(a), top + 1.5 + 0.8 * std::sin(a)};
  };
  const auto turn_to = [&](double degrees, bool button) {
    return point(at(degrees).x, at(degrees).y, button);
  };
  (void)turn_to(10.0, false);
  (void)turn_to(10.0, true);
  ASSERT_TRUE(menu_.held());
  for (int degrees = 12; degrees <= 100; degrees += 2) (void)turn_to(degrees, true);
  EXPECT_EQ(menu_.value(kTurn), 120.0) << "by 90 degrees, clockwise as seen";
  for (int degrees = 100; degrees >= -250; degrees -= 2) (void)turn_to(degrees, true);
  EXPECT_EQ(menu_.value(kTurn), 0.0) << "held at its end";
}

TEST(DialRange, HasNoDetentsWithoutAStep) {
  const DialRange smooth{-1.0, 1.0, 0.0};
  EXPECT_EQ(smooth.held(0.123, 0.0), 0.123);
  EXPECT_EQ(smooth.held(7.0, 0.0), 1.0);
  EXPECT_EQ(smooth.part(0.0), 0.5);
}

TEST_F(SpaceMenuTest, IsDrawnAsASignOfItsPlace) {
  (void)point(1.0, 1.5);
  const LabelView label = menu_.drawn();
  EXPECT_EQ(label.origin, kCorner);
  EXPECT_EQ(label.unit, kEntry);
  EXPECT_EQ(label.texts.size(), 8U) << "seven items, of which two are behind one, and the knob's value";
}

}  // namespace
}  // namespace palpate
