// Picking by a ray and through an aperture, against what geometry says.

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/hand/technique/scene_pick.h"

namespace palpate {
namespace {

TEST(PickByRay, TakesTheFirstOneThatItHits) {
  const std::vector<PickBall> balls{{{0.0, 0.0, -5.0}, 1.0}, {{0.0, 0.5, -3.0}, 0.6}, {{0.0, 0.0, 4.0}, 1.0}};
  EXPECT_EQ(pick_by_ray({Vec3(0.0), {0.0, 0.0, -1.0}}, balls), 1U);
  EXPECT_EQ(pick_by_ray({Vec3(0.0, -0.2, 0.0), {0.0, 0.0, -1.0}}, balls), 0U) << "past the nearer one";
  EXPECT_EQ(pick_by_ray({Vec3(0.0), {0.0, 0.0, 1.0}}, balls), 2U);
  EXPECT_EQ(pick_by_ray({Vec3(0.0), {1.0, 0.0, 0.0}}, balls), std::nullopt);
  EXPECT_EQ(pick_by_ray({Vec3(0.0, 0.0, -5.5), {0.0, 0.0, -1.0}}, balls), 0U) << "from within";
  EXPECT_EQ(pick_by_ray({Vec3(0.0, 0.0, -6.5), {0.0, 0.0, -1.0}}, balls), std::nullopt) << "behind it";
  const std::vector<PickBall> turned{balls[1], balls[0]};
  EXPECT_EQ(pick_by_ray({Vec3(0.0), {0.0, 0.0, -1.0}}, turned), 0U) << "in whatever order they come";
}

// A ray hits a ball where one of many points along it lies in the ball.
TEST(PickByRay, AgreesWithPointsAlongTheRay) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    const auto place = [&] { return Vec3{anywhere(random), anywhere(random), anywhere(random)}; };
    std::vector<PickBall> balls;
    for (int i = 0; i < 6; ++i) balls.push_back({place(), 0.1 + 0.2 * std::abs(anywhere(random))});
    const Ray ray{2.0 * place(), glm::normalize(place())};
    // Where a ball is first met, by points along the ray; beyond the last one it is met nowhere.
    constexpr double kStep = 1e-3;
    constexpr int kPoints = 5000;
    const auto met_at = [&](const PickBall& ball) {
      int k = 0;
      while (k < kPoints && glm::distance(ray.origin + k * kStep * ray.direction, ball.center) > ball.radius)
        ++k;
      return k;
    };
    int first = kPoints;
    for (const PickBall& ball : balls) first = std::min(first, met_at(ball));
    const auto picked = pick_by_ray(ray, balls);
    if (first < kPoints) {
      ASSERT_TRUE(picked.has_value());
      const Vec3 to = balls[*picked].center - ray.origin;
      const double along = glm::dot(to, ray.direction), aside = glm::length(to - along * ray.direction);
      const double half = std::sqrt(std::pow(balls[*picked].radius, 2) - aside * aside);
      // It begins before the next of the points, whether these meet it or step over it.
      EXPECT_LE(along - half, kStep * first);
    } else if (picked) {
      // Grazed between two of the points.
      const Vec3 to = balls[*picked].center - ray.origin;
      const double aside = glm::length(to - glm::dot(to, ray.direction) * ray.direction);
      EXPECT_GT(aside, balls[*picked].radius - 1e-4);
    }
  }
}

TEST(PickByAperture, TakesWhatIsNearestToTheAxisOfItsCone) {
  // Two small ones that no ray through the middle hits, and one beside the cone.
  const std::vector<PickBall> balls{
      {{0.3, 0.0, -10.0}, 0.05}, {{-0.2, 0.0, -10.0}, 0.05}, {{2.0, 0.0, -10.0}, 0.05}};
  const Aperture aperture{Vec3(0.0), {0.0, 0.0, -0.5}, 0.02};  // 2.3 degrees: 0.4 at a distance of 10
  EXPECT_EQ(pick_by_ray({Vec3(0.0), {0.0, 0.0, -1.0}}, balls), std::nullopt);
  EXPECT_EQ(pick_by_aperture(aperture, balls), 1U);
  // Held to the side, it looks elsewhere.
  EXPECT_EQ(pick_by_aperture({Vec3(0.0), {0.1, 0.0, -0.5}, 0.02}, balls), 2U);
  EXPECT_EQ(pick_by_aperture({Vec3(0.0), {0.0, 0.2, -0.5}, 0.02}, balls), std::nullopt);
  // A wider one behind counts only by its centre; of two in line the nearer counts.
  const std::vector<PickBall> in_line{{{0.0, 0.0, -10.0}, 0.1}, {{0.0, 0.0, -6.0}, 0.1}};
  EXPECT_EQ(pick_by_aperture(aperture, in_line), 1U);
  EXPECT_EQ(pick_by_aperture(aperture, {}), std::nullopt);
}

// What a wide ball shows of itself in the cone is enough, to within the sum of both angles and no more.
TEST(PickByAperture, HoldsBallsThatReachIntoTheCone) {
  const double half = std::atan2(0.02, 0.5), seen = std::asin(0.5 / 4.0);
  for (const double off : {0.98, 1.02}) {
    const double angle = off * (half + seen);
    const std::vector<PickBall> balls{{4.0 * Vec3(std::sin(angle), 0.0, -std::cos(angle)), 0.5}};
    EXPECT_EQ(pick_by_aperture({Vec3(0.0), {0.0, 0.0, -0.5}, 0.02}, balls).has_value(), off < 1.0);
  }
}

}  // namespace
}  // namespace palpate
