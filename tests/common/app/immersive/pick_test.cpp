// Picking by a ray and through an aperture, against what geometry says.

#include "common/app/immersive/pick.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

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
    std::optional<std::size_t> expected;
    constexpr double kStep = 1e-3;
    for (int k = 0; k < 5000 && !expected; ++k) {
      for (std::size_t i = 0; i < balls.size(); ++i) {
        if (glm::distance(ray.origin + k * kStep * ray.direction, balls[i].center) <= balls[i].radius)
          expected = i;
      }
    }
    const auto picked = pick_by_ray(ray, balls);
    if (picked != expected && picked) {
      // Grazed between two of the points, or two begin within a step of each other.
      const Vec3 to = balls[*picked].center - ray.origin;
      const double aside = glm::length(to - glm::dot(to, ray.direction) * ray.direction);
      EXPECT_GT(aside, expected ? 0.0 : balls[*picked].radius - 1e-4);
    } else {
      EXPECT_EQ(picked, expected);
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
