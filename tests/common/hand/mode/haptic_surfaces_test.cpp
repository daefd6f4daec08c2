// Isosurfaces that are felt, made beside the hand. No time is asserted; every wait gives up after half a
// minute.

#include "common/hand/mode/haptic_surfaces.h"

#include <chrono>
#include <functional>

#include <gtest/gtest.h>

#include "common/field/analytic/volume_examples.h"
#include "tests/support/torus_scalar.h"

namespace palpate {
namespace {

bool wait_for(const std::function<bool()>& happened) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (!happened()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

/// Whether the surfaces of exactly these levels are there.
bool has_levels(const HapticSurfaces& surfaces, const std::vector<double>& levels) {
  const HapticSurfaces::Made made = surfaces.made();
  if (made.meshes.size() != levels.size()) return false;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (!made.meshes[i] || made.meshes[i]->level != levels[i]) return false;
  }
  return true;
}

TEST(HapticSurfaces, AreMadeOnRequestAndKeptWhileTheirValuesStay) {
  HapticSurfaces surfaces([] {});
  EXPECT_TRUE(surfaces.made().meshes.empty());
  const auto field = make_scalar_field(sphere_scalar());
  surfaces.request({field, {{1.0}, 1}});
  ASSERT_TRUE(wait_for([&] { return has_levels(surfaces, {1.0}); }));
  const auto first = surfaces.made().meshes[0];
  EXPECT_FALSE(first->triangles.empty());
  ASSERT_TRUE(surfaces.made().histogram);
  surfaces.request({field, {{0.25, 1.0}, 2}});
  ASSERT_TRUE(wait_for([&] { return has_levels(surfaces, {0.25, 1.0}); }));
  EXPECT_EQ(surfaces.made().meshes[1], first) << "not made again";
  surfaces.request({});
  EXPECT_TRUE(surfaces.made().meshes.empty()) << "at once";
}

TEST(HapticSurfaces, TheLatestRequestWins) {
  HapticSurfaces surfaces([] {});
  const auto sphere = make_scalar_field(sphere_scalar());
  for (int i = 1; i <= 20; ++i) surfaces.request({sphere, {{0.05 * i}, 1}});
  ASSERT_TRUE(wait_for([&] { return has_levels(surfaces, {0.05 * 20}); }));
  const auto torus = make_scalar_field(test::torus_scalar());
  surfaces.request({torus, {{0.16}, 1}});
  EXPECT_TRUE(surfaces.made().meshes.empty()) << "nothing of the other field";
  EXPECT_TRUE(wait_for([&] { return has_levels(surfaces, {0.16}); }));
}

TEST(FeltLevel, IsThatOfTheSurfaceThatAProxyIsOn) {
  const HapticLevels felt{make_scalar_field(sphere_scalar()), {{0.25, 1.0}, 2}};
  EXPECT_EQ(haptic_level(felt, 0.25 + 1e-9), 0.25);
  EXPECT_EQ(haptic_level(felt, 1.0), 1.0);
  EXPECT_FALSE(haptic_level(felt, 0.26)) << "beside it";
  EXPECT_FALSE(haptic_level({}, 0.25));
}

TEST(FirstSurfaceBetween, IsTheNearSideOfTheFirstLevelMet) {
  const HapticLevels felt{make_scalar_field(sphere_scalar()), {{0.25, 1.0}, 2}};
  const auto met = first_surface_between(felt, {-10.0, 0.1, 0.0}, {10.0, 0.1, 0.0});
  ASSERT_TRUE(met);
  EXPECT_NEAR(met->x, -std::sqrt(0.99), 1e-9) << "of the outer sphere";
  const auto from_inside = first_surface_between(felt, Vec3{0.0}, {0.0, 0.0, 5.0});
  ASSERT_TRUE(from_inside);
  EXPECT_NEAR(from_inside->z, 0.5, 1e-9);
  EXPECT_FALSE(first_surface_between(felt, {-10.0, 1.2, 0.0}, {10.0, 1.2, 0.0})) << "it passes by";
  EXPECT_FALSE(first_surface_between(felt, {-10.0, 7.0, 0.0}, {10.0, 7.0, 0.0})) << "outside the data";
  EXPECT_FALSE(first_surface_between({}, Vec3{0.0}, {0.0, 0.0, 5.0}));
  EXPECT_FALSE(first_surface_between(felt, Vec3{NAN}, {0.0, 0.0, 5.0}));
}

}  // namespace
}  // namespace palpate
