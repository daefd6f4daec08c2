// Textures that tell of noise: where they stick and slip, and that they only take energy.
#include "common/haptics/constraint/noise_texture.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/field/analytic/analytic_scalar.h"
#include "common/field/analytic/volume_examples.h"
#include "common/haptics/proxy_chain.h"
#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

/// Noise that rises with x, from nothing at x = 0.
class Ramp final : public AnalyticScalar {
 public:
  [[nodiscard]] double value(const Vec3& x) const noexcept override { return std::max(0.0, x.x); }
  [[nodiscard]] Jet3 jet(const Vec3&) const noexcept override { return {}; }
  [[nodiscard]] Box bounds() const noexcept override { return {Vec3{-1.0}, Vec3{1.0}}; }
  [[nodiscard]] std::string name() const override { return "ramp"; }
  [[nodiscard]] std::string description() const override { return {}; }
};

std::shared_ptr<const ScalarField> ramp() { return make_scalar_field(std::make_shared<Ramp>()); }

/// A grain of 10 mm where the noise is 1.
ChainSettings with_grain() {
  ChainSettings settings;
  settings.texture = {.by_noise = true, .grain = {{0.0, 0.0}, {1.0, 0.01}}};
  return settings;
}

TEST(NoiseTexture, SticksForAGrainAndSlipsToTheHand) {
  const auto noise = ramp();
  NoiseTexture texture(noise, Workspace(1.0, noise->frame()));
  texture.apply(with_grain());
  Vec3 stuck{0.5, 0.0, 0.0};
  LinkUpdate link;
  int slips = 0;
  for (int i = 0; i <= 1000; ++i) {
    const Vec3 probe{0.5, 0.0001 * i, 0.0};
    link = {};
    texture.update(probe, {}, link);
    if (link.proxy != stuck) {
      ++slips;
      EXPECT_EQ(link.proxy, probe);
      EXPECT_GT(glm::distance(stuck, probe), 0.005) << "half of 10 mm at half the noise";
      EXPECT_LT(glm::distance(stuck, probe), 0.0052);
      stuck = link.proxy;
    }
    EXPECT_EQ(link.state, HoldState::kHeld);
  }
  EXPECT_EQ(slips, 19) << "100 mm in steps of 5.1 mm";
}

TEST(NoiseTexture, IsNotThereWhereThereIsNoNoise) {
  const auto noise = ramp();
  NoiseTexture texture(noise, Workspace(1.0, noise->frame()));
  texture.apply(with_grain());
  for (const Vec3& probe : {Vec3{-0.5, 0.0, 0.0}, Vec3{-0.5, 0.001, 0.0}, Vec3{5.0}, Vec3{5.001}}) {
    LinkUpdate link;
    texture.update(probe, {}, link);
    EXPECT_EQ(link.proxy, probe);
    EXPECT_EQ(link.state, HoldState::kFree) << "what it says of a probe outside the data is left to others";
    EXPECT_EQ(link.jacobian, Mat3{1.0});
  }
}

// After a surface the grain is on that alone, and every place of its proxy is one of the surface.
TEST(NoiseTexture, OfASurfaceIsOnThatAlone) {
  const auto field = make_scalar_field(sphere_scalar());
  const auto noise = ramp();
  const Workspace workspace(1.0, field->frame());
  auto surface = std::make_unique<IsosurfaceConstraint>(field, workspace);
  const IsosurfaceConstraint& its = *surface;
  ChainSettings settings = with_grain();
  settings.isosurface.isovalues = {{0.25}, 1};  // |x| = 0.5
  settings.isosurface.depth = 0.2;
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::move(surface));
  links.push_back(std::make_unique<NoiseTexture>(noise, workspace, &its));
  ProxyChain chain(std::move(links), settings);
  int held = 0, rubbed = 0;
  for (int i = 0; i < 4000; ++i) {
    const double angle = 0.0002 * i, radius = i < 1000   ? 0.6 - 0.0002 * i
                                              : i < 3000 ? 0.4
                                                         : 0.4 + 0.0002 * (i - 3000);
    const Vec3 probe = radius * Vec3{std::cos(angle), std::sin(angle), 0.0};
    const ChainStep step = chain.step(probe);
    if (its.held_by() < 0) {
      EXPECT_EQ(step.proxies[1], probe);
      continue;
    }
    ++held;
    EXPECT_NEAR(glm::length(step.proxies[1]), 0.5, 1e-12);
    EXPECT_LE(glm::distance(step.proxies[0], step.proxies[1]), 0.01 * step.proxies[0].x + 1e-15);
    rubbed += step.proxies[0] != step.proxies[1] ? 1 : 0;
  }
  EXPECT_GT(held, 2500);
  EXPECT_GT(rubbed, held / 2);
}

// Round and round, the hand never gets more out than the spring held when it was last put in.
TEST(NoiseTexture, OnlyTakesEnergy) {
  const auto noise = ramp();
  const Workspace workspace(1.0, noise->frame());
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::make_unique<NoiseTexture>(noise, workspace));
  const ChainSettings settings = with_grain();
  ProxyChain chain(std::move(links), settings);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Vec3 at{0.3, 0.0, 0.0}, before = at, velocity{0.0};
  double given = 0.0;  // to the hand
  Vec3 force = chain.step(at).force;
  for (int i = 0; i < 200'000; ++i) {
    velocity = 0.99 * velocity + 1e-5 * Vec3{normal(random), normal(random), normal(random)} -
               1e-4 * (at - Vec3{0.3, 0, 0});
    at += velocity;
    const Vec3 next = chain.step(at).force;
    given += glm::dot(force, at - before);  // held over the step, as a servo does
    // Held forces lag behind a moving hand by a step, which takes half of k dx^2 more (or less) each.
    given -= 0.5 * settings.stiffness * glm::dot(at - before, at - before);
    before = at;
    force = next;
    ASSERT_LE(given, 0.5 * settings.stiffness * 0.01 * 0.01);
  }
  EXPECT_LT(given, -0.01) << "[J]; it has been rubbed";
}

TEST(NoiseTexture, AllocatesNothing) {
  const auto noise = ramp();
  NoiseTexture texture(noise, Workspace(1.0, noise->frame()));
  const ChainSettings settings = with_grain();
  LinkUpdate link;
  const AllocationGuard guard;
  texture.apply(settings);
  for (int i = 0; i < 1000; ++i) texture.update(Vec3{0.001 * i, 0.0, 0.0}, {}, link);
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace palpate::test
