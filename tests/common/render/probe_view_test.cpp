#include "common/render/probe_view.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/render/scene_view.h"
#include "tests/common/render/sample_probe.h"

namespace palpate {
namespace {

TEST(ProbeView, ForcesSpreadUpToTheCapUnlessSaidOtherwise) {
  ProbeView view;
  view.force_cap = 3.0;
  EXPECT_EQ(force_range(view), (ValueRange{0.0, 3.0}));
  view.path.range = ValueRange{1.0, 2.0};
  EXPECT_EQ(force_range(view), (ValueRange{1.0, 2.0}));
}

TEST(ProbeView, NeighbouringNumbersHaveDifferentColours) {
  for (int number = -7; number < 20; ++number)
    EXPECT_NE(cached_color(number), cached_color(number + 1)) << number;
  EXPECT_EQ(cached_color(1), cached_color(8));
}

// Every member makes another picture, or the window would not be drawn anew.
TEST(ProbeView, EachChangeIsAnotherPicture) {
  SceneView scene = test::whirlwind(1.0);
  scene.probe = test::sample_probe(scene);
  const auto changed = [&](auto change) {
    SceneView other = scene;
    change(*other.probe);
    return !same_picture(scene, other);
  };
  EXPECT_FALSE(changed([](ProbeView&) {}));
  EXPECT_TRUE(changed([](ProbeView& p) { p.probe.x += 1e-3; }));
  EXPECT_TRUE(changed([](ProbeView& p) { p.proxy.y += 1e-3; }));
  EXPECT_TRUE(changed([](ProbeView& p) { p.force *= 1.01; }));
  EXPECT_TRUE(changed([](ProbeView& p) { p.force_cap *= 1.01; }));
  EXPECT_TRUE(changed([](ProbeView& p) { p.show_force = false; }));
  EXPECT_TRUE(changed([](ProbeView& p) { p.velocity *= 2.0; }));
  EXPECT_TRUE(changed([](ProbeView& p) { p.reference_speed *= 2.0; }));
  EXPECT_TRUE(changed([](ProbeView& p) { p.followed = std::make_shared<FollowedLine>(*p.followed); }));
  EXPECT_TRUE(changed([](ProbeView& p) { --p.path.count; }));
  EXPECT_TRUE(changed([](ProbeView& p) { p.path.range = ValueRange{}; }));
  EXPECT_TRUE(changed([](ProbeView& p) { p.seeds.reset(); }));
  EXPECT_TRUE(changed([](ProbeView& p) { p.drawn_lines.reset(); }));
  EXPECT_TRUE(changed([](ProbeView& p) { p.style.ball_size *= 2.0; }));
  SceneView without = scene;
  without.probe.reset();
  EXPECT_FALSE(same_picture(scene, without));
  EXPECT_FALSE(same_picture(without, scene));
}

// NaN is not equal to itself: a fault would have the window draw the same picture again and again.
TEST(ProbeView, WhatIsNotDrawnIsTheSameWhateverItIs) {
  ProbeView a, b;
  a.probe = Vec3(NAN, 0.0, 0.0);
  b.probe = Vec3(0.0, HUGE_VAL, 1.0);
  a.velocity = b.velocity = Vec3(NAN);
  a.force = b.force = std::nan("");
  EXPECT_TRUE(same_picture(a, b));
  b.probe = Vec3(0.0);
  EXPECT_FALSE(same_picture(a, b));
}

}  // namespace
}  // namespace palpate
