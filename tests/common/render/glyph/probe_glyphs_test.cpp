#include "common/render/glyph/probe_glyphs.h"

#include <cmath>
#include <tuple>

#include <gtest/gtest.h>

#include "common/render/color/palette.h"
#include "tests/common/render/sample_probe.h"

namespace palpate {
namespace {

// A probe at the middle of a box whose scene frame is the data, its proxy `stretch` beside it; height 2.
SceneView simple_view(double stretch) {
  SceneView view;
  view.bounds = {Vec3(-0.5), Vec3(0.5)};
  view.camera.view_height = 2.0;
  ProbeView probe;
  probe.probe = Vec3(0.0);
  probe.proxy = Vec3(stretch, 0.0, 0.0);
  probe.force_cap = 2.0;
  probe.force = 1.0;
  view.probe = probe;
  return view;
}

ProbeGlyphs glyphs_of(const SceneView& view) {
  return make_probe_glyphs(view, scene_frame(view.bounds), {0.0, 1.0});
}

TEST(ProbeGlyphs, SizesAreInThousandthsOfTheHeight) {
  SceneView view = simple_view(0.5);
  view.probe->style.probe_size = 20.0;
  for (const double zoomed : {1.0, 0.125}) {
    view.camera.view_height = 2.0 * zoomed;
    const ProbeGlyphs glyphs = glyphs_of(view);
    ASSERT_EQ(glyphs.spheres.size(), 2U);  // proxy, probe
    EXPECT_FLOAT_EQ(glyphs.spheres[1].radius, static_cast<float>(0.020 * zoomed));
  }
}

// A chain: a smaller ball for each proxy but the one that stands for it, and thin lines from link to link.
TEST(ProbeGlyphs, ShowAllProxiesOfAChain) {
  SceneView view = simple_view(0.3);
  const ProbeView alone = *view.probe;
  const Vec3 second{0.3, 0.2, 0.0}, third{0.1, 0.2, 0.0};
  view.probe->links = {view.probe->proxy, second, third};
  EXPECT_FALSE(same_picture(*view.probe, alone));
  ProbeGlyphs glyphs = glyphs_of(view);
  ASSERT_EQ(glyphs.spheres.size(), 4U);  // proxy, probe, two links
  for (const std::size_t i : {2U, 3U}) {
    EXPECT_LT(glyphs.spheres[i].radius, glyphs.spheres[0].radius);
    EXPECT_EQ(glyphs.spheres[i].color, glyphs.spheres[0].color);
  }
  EXPECT_EQ(glyphs.spheres[2].center, Vec3f(second));
  EXPECT_EQ(glyphs.spheres[3].center, Vec3f(third));
  ASSERT_EQ(glyphs.arrows.size(), 3U);  // two lines, the band
  EXPECT_LT(glyphs.arrows[1].shaft_radius, glyphs.arrows[2].shaft_radius) << "thinner than the band";
  EXPECT_FLOAT_EQ(glyphs.arrows[0].shaft_length, 0.2F);
  EXPECT_EQ(glyphs.arrows[1].origin, Vec3f(second));

  // On a heart the last link stands for the chain.
  view.probe->proxy = third;
  EXPECT_EQ(glyphs_of(view).spheres[2].center, Vec3f(0.3F, 0.0F, 0.0F));
  // One link is the proxy itself; what is not finite is not drawn.
  view.probe->links = {third};
  EXPECT_EQ(glyphs_of(view).spheres.size(), 2U);
  view.probe->links = {third, Vec3(HUGE_VAL)};
  EXPECT_EQ(glyphs_of(view).spheres.size(), 2U);
  EXPECT_EQ(glyphs_of(view).arrows.size(), 1U);
}

TEST(ProbeGlyphs, BandThinsAsItStretchesAndTakesTheColourOfTheTension) {
  float before = 1e9F;
  for (const double stretch : {0.01, 0.1, 0.3, 0.6}) {
    const ProbeGlyphs glyphs = glyphs_of(simple_view(stretch));
    ASSERT_EQ(glyphs.arrows.size(), 1U);
    const ArrowInstance& band = glyphs.arrows.front();
    EXPECT_FLOAT_EQ(band.shaft_length, static_cast<float>(stretch));
    EXPECT_LT(band.shaft_radius, before);
    EXPECT_EQ(band.head_length, 0.0F);
    EXPECT_EQ(band.color, map_color(ColorMap::kTension, 0.5));
    before = band.shaft_radius;
  }
  // Path and band share the colour bar.
  SceneView ranged = simple_view(0.1);
  ranged.probe->path.range = ValueRange{0.0, 4.0};
  EXPECT_EQ(glyphs_of(ranged).arrows.front().color, map_color(ColorMap::kTension, 0.25));
  // At the rest length: 1/sqrt(2) of the width.
  SceneView view = simple_view(0.08);
  view.probe->style.band_rest = 40.0;
  view.probe->style.band_width = 10.0;
  EXPECT_FLOAT_EQ(glyphs_of(view).arrows.front().shaft_radius, static_cast<float>(0.010 / std::sqrt(2.0)));
}

TEST(ProbeGlyphs, ArrowHasTheDirectionAndLengthOfTheVelocity) {
  SceneView view = simple_view(0.0);
  view.probe->reference_speed = 5.0;
  view.probe->style.arrow_length = 100.0;
  const auto length_at = [&](const Vec3& velocity) {
    view.probe->velocity = velocity;
    const ProbeGlyphs glyphs = glyphs_of(view);
    if (glyphs.arrows.empty()) return 0.0;
    const ArrowInstance& arrow = glyphs.arrows.front();
    EXPECT_LT(glm::distance(Vec3(arrow.axis), glm::normalize(velocity)), 1e-6);
    return double{arrow.shaft_length} + arrow.head_length;
  };
  EXPECT_NEAR(length_at({3.0, 0.0, 4.0}), 0.2, 1e-6);
  EXPECT_NEAR(length_at({0.0, -2.5, 0.0}), 0.1, 1e-6);
  EXPECT_NEAR(length_at({0.0, 0.0, 1e9}), 0.6, 1e-6);  // three times the reference at most
  EXPECT_EQ(length_at(Vec3(0.0)), 0.0);
  EXPECT_EQ(length_at(Vec3(0.0, NAN, 0.0)), 0.0);
  EXPECT_EQ(length_at(Vec3(0.0, HUGE_VAL, 0.0)), 0.0);
  for (const double speed : {0.0, -1.0, std::nan("")}) {
    view.probe->reference_speed = speed;
    EXPECT_EQ(length_at({1.0, 0.0, 0.0}), 0.0);
  }
}

TEST(ProbeGlyphs, WhatIsNotFiniteIsLeftOut) {
  SceneView view = simple_view(0.5);
  view.probe->reference_speed = 1.0;
  view.probe->velocity = Vec3(1.0, 0.0, 0.0);
  view.probe->probe = view.probe->proxy = Vec3(NAN);
  auto followed = std::make_shared<FollowedLine>();
  followed->balls = {Vec3(0.0, NAN, 0.0), Vec3(HUGE_VAL)};
  view.probe->followed = followed;
  auto seeds = std::make_shared<LocalSeeds>();
  seeds->shape = SeedShape::kRake;
  seeds->origin = Vec3(NAN);
  seeds->seeds = {Vec3(NAN)};
  view.probe->seeds = seeds;
  const ProbeGlyphs glyphs = glyphs_of(view);
  EXPECT_TRUE(glyphs.spheres.empty());
  EXPECT_TRUE(glyphs.arrows.empty());
}

TEST(ProbeGlyphs, BallsHaveTheColoursOfTheLines) {
  SceneView view = simple_view(0.5);
  auto followed = std::make_shared<FollowedLine>();
  followed->balls = {Vec3(0.1), Vec3(0.2), Vec3(0.3)};
  followed->ball_values = {0.25, 7.0, std::nan("")};
  followed->ball_radius = 0.125;
  view.probe->followed = followed;
  const ProbeGlyphs glyphs = glyphs_of(view);
  ASSERT_EQ(glyphs.spheres.size(), 5U);
  EXPECT_EQ(glyphs.spheres[0].color, map_color(ColorMap::kSequential, 0.25));
  EXPECT_EQ(glyphs.spheres[1].color, map_color(ColorMap::kSequential, 1.0));
  EXPECT_EQ(glyphs.spheres[2].color, map_color(ColorMap::kSequential, std::nan("")));
  EXPECT_EQ(glyphs.spheres[0].radius, 0.125F);  // the box has no other scale than its own
  view.style.color_by = ColorBy::kUniform;
  EXPECT_EQ(glyphs_of(view).spheres[0].color, palette_of(view.background).plain_line);
}

TEST(ProbeGlyphs, RakeAndPlaneHaveBarsAndHandles) {
  SceneView view = simple_view(0.5);
  view.probe->probe = view.probe->proxy = Vec3(NAN);
  auto seeds = std::make_shared<LocalSeeds>();
  seeds->u = Vec3(0.5, 0.0, 0.0);
  seeds->v = Vec3(0.0, 0.25, 0.0);
  seeds->seeds = {Vec3(0.1), Vec3(0.2)};
  view.probe->seeds = seeds;
  for (const auto& [shape, handles, bars] :
       {std::tuple{SeedShape::kNone, 0U, 0U}, {SeedShape::kRake, 2U, 1U}, {SeedShape::kPlane, 4U, 4U}}) {
    seeds->shape = shape;
    const ProbeGlyphs glyphs = glyphs_of(view);
    EXPECT_EQ(glyphs.spheres.size(), handles + 2U);
    EXPECT_EQ(glyphs.arrows.size(), bars);
  }
}

TEST(ProbeGlyphs, ScalingTheDataByAPowerOfTwoGivesTheSameBits) {
  const auto of = [](double scale) {
    SceneView view = test::whirlwind(1.0, 60, scale);
    view.probe = test::sample_probe(view);
    return glyphs_of(view);
  };
  const ProbeGlyphs a = of(1.0), b = of(std::ldexp(1.0, -40));
  ASSERT_EQ(a.spheres.size(), b.spheres.size());
  ASSERT_EQ(a.arrows.size(), b.arrows.size());
  for (std::size_t i = 0; i < a.spheres.size(); ++i) {
    EXPECT_EQ(a.spheres[i].center, b.spheres[i].center);
    EXPECT_EQ(a.spheres[i].radius, b.spheres[i].radius);
  }
  for (std::size_t i = 0; i < a.arrows.size(); ++i) {
    EXPECT_EQ(a.arrows[i].origin, b.arrows[i].origin);
    EXPECT_EQ(a.arrows[i].axis, b.arrows[i].axis);
    EXPECT_EQ(a.arrows[i].shaft_length, b.arrows[i].shaft_length);
  }
}

}  // namespace
}  // namespace palpate
