#include "common/haptics/force_field/force_field.h"

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/examples.h"
#include "common/haptics/proxy_chain.h"
#include "tests/common/field/sampled_fields.h"
#include "tests/common/trace/helix_field.h"
#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

using Maker =
    std::function<std::unique_ptr<Constraint>(std::shared_ptr<const VectorField>, const Workspace&)>;

template <typename Mode>
Maker of_flow() {
  return [](auto field, const Workspace& workspace) { return std::make_unique<Mode>(field, workspace); };
}
const Maker kDensity = [](const auto& field, const Workspace& workspace) {
  return std::make_unique<DensityDrag>(make_speed_field(field), workspace);
};

ProxyChain chain_of(const Maker& maker, const std::shared_ptr<const VectorField>& field, double scale,
                    const ForceFieldSettings& force_field = {}) {
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(maker(field, Workspace(scale, field->frame())));
  ChainSettings settings;
  settings.force_field = force_field;
  return {std::move(links), settings};
}

std::shared_ptr<const VectorField> helix(double rise) {
  return make_vector_field(std::make_shared<HelixField>(rise));
}

TEST(ForceField, TheProxyIsTheProbe) {
  for (const Maker& maker :
       {of_flow<DirectDisplay>(), of_flow<VortexPull>(), of_flow<TransverseDamping>(), kDensity}) {
    ProxyChain chain = chain_of(maker, helix(0.5), 0.05);
    const Vec3 probe{0.02, -0.03, 0.01};
    const ChainStep inside = chain.step(probe, {0.1, 0.2, 0.3});
    EXPECT_EQ(inside.proxy(probe), probe);
    EXPECT_EQ(inside.state, HoldState::kHeld);
    EXPECT_EQ(inside.residual, 0.0);
    EXPECT_GT(glm::length(inside.force), 0.0);
    const ChainStep outside = chain.step({0.2, 0.0, 0.0}, {0.1, 0.2, 0.3});
    EXPECT_EQ(outside.state, HoldState::kOutside);
    EXPECT_EQ(outside.force, Vec3(0.0));
    EXPECT_FALSE(outside.jumped);
  }
}

TEST(ForceField, DirectDisplayCarriesAlongTheFlow) {
  const auto field = helix(1.0);
  ProxyChain chain = chain_of(of_flow<DirectDisplay>(), field, 0.05, {.strength = 2.0});
  // At (1, 0, 0) v = (0, 1, 1).
  const Vec3 force = chain.step({0.05, 0.0, 0.0}).force;
  EXPECT_LT(glm::distance(force, Vec3(0.0, 2.0, 2.0) / field->max_speed()), 1e-15);
}

TEST(ForceField, VortexPullPointsToTheAxisAndGrowsWithTheDistanceFromIt) {
  ProxyChain chain = chain_of(of_flow<VortexPull>(), helix(1.0), 0.05);
  const Vec3 near = chain.step({0.03, 0.04, 0.02}).force, far = chain.step({0.06, 0.08, -0.02}).force;
  EXPECT_LT(glm::length(glm::cross(near, Vec3{3, 4, 0})), 1e-14);
  EXPECT_LT(near.x, 0.0);
  EXPECT_LT(glm::distance(far, 2.0 * near), 1e-13);
  EXPECT_LE(glm::length(far), 1.0);
  EXPECT_LT(glm::length(chain.step({0.0, 0.0, 0.05}).force), 1e-15) << "on the axis";
}

TEST(ForceField, AFlowWithoutVorticesPullsNowhere) {
  // omega = v everywhere: what is left of omega x v is rounding, or on a grid its error, most of it in the
  // cells of the border; neither is blown up to the full strength.
  const auto flow = example("abc");
  const auto mean_force = [&](const std::shared_ptr<const VectorField>& field) {
    ProxyChain chain = chain_of(of_flow<VortexPull>(), field, 0.02);
    std::mt19937_64 random(1);
    double sum = 0.0;
    constexpr int kPoints = 500;
    for (int i = 0; i < kPoints; ++i) {
      sum += glm::length(chain.step(0.02 * random_in(flow->bounds(), random)).force) / kPoints;
    }
    return sum;
  };
  EXPECT_LT(mean_force(make_vector_field(flow)), 1e-12);
  EXPECT_LT(mean_force(field_of(sample_uniform(*flow, {48, 48, 48}, SampledType::kFloat64))), 0.1);
}

// A potential flow, v = grad (x^2 / 3 + 7 y^2 / 10 - 31 z^2 / 30 + x y / 7): its vorticity is the rounding of the
// values alone, which was taken for the strongest vortex there is, and pulled with all the strength.
TEST(ForceField, RoundingIsNoVortex) {
  struct Potential final : public AnalyticField {
    [[nodiscard]] Vec3 velocity(const Vec3& x) const noexcept override {
      return {3.3 + 2.0 / 3.0 * x.x + x.y / 7.0, 1.1 + 1.4 * x.y + x.x / 7.0, 0.7 - 31.0 / 15.0 * x.z};
    }
    [[nodiscard]] Mat3 jacobian(const Vec3&) const noexcept override {
      return {{2.0 / 3.0, 1.0 / 7.0, 0.0}, {0.142857142857142877, 1.4, 0.0}, {0.0, 0.0, -31.0 / 15.0}};
    }
    [[nodiscard]] Box bounds() const noexcept override { return {{0.1, -0.3, 0.2}, {1.3, 0.9, 1.7}}; }
    [[nodiscard]] std::string name() const override { return "potential"; }
    [[nodiscard]] std::string description() const override { return "potential"; }
  };
  const Potential flow;
  std::vector<std::shared_ptr<const VectorField>> fields{make_vector_field(std::make_shared<Potential>())};
  for (const SampledType type : {SampledType::kFloat32, SampledType::kFloat64}) {
    fields.push_back(field_of(sample_uniform(flow, {20, 17, 23}, type)));
    fields.push_back(field_of(sample_rectilinear(flow, {20, 17, 23}, 4.0, type)));
    fields.push_back(field_of(sample_tetrahedra(flow, {9, 8, 7}, 0.2, 1, type)));
  }
  for (std::size_t f = 0; f < fields.size(); ++f) {
    ProxyChain chain = chain_of(of_flow<VortexPull>(), fields[f], 0.02);
    std::mt19937_64 random(1);
    for (int i = 0; i < 200; ++i) {
      ASSERT_EQ(chain.step(0.02 * random_in(flow.bounds(), random)).force, Vec3(0.0)) << "field " << f;
    }
  }
}

// A hand that goes round, at any place and in any plane: a drag never gives anything back.
TEST(ForceField, DragsTakeEnergyOnEveryClosedLoop) {
  const auto field = make_vector_field(example("tornado"));
  const double scale = Workspace::default_scale(field->diagonal());
  for (const Maker& maker : {of_flow<TransverseDamping>(), kDensity}) {
    ProxyChain chain = chain_of(maker, field, scale);
    std::mt19937_64 random(2);
    for (int loop = 0; loop < 20; ++loop) {
      const Vec3 center = scale * random_in(field->bounds(), random);
      const Vec3 a = 0.05 * (random_in({Vec3{-1.0}, Vec3{1.0}}, random));
      const Vec3 b = 0.05 * (random_in({Vec3{-1.0}, Vec3{1.0}}, random));
      constexpr int kSteps = 2000;
      constexpr double kTurn = 2.0 * std::numbers::pi;
      double work = 0.0;
      for (int i = 0; i < kSteps; ++i) {
        const double angle = kTurn * i / kSteps;
        const Vec3 velocity = kTurn * (std::cos(angle) * b - std::sin(angle) * a);
        const Vec3 force = chain.step(center + std::cos(angle) * a + std::sin(angle) * b, velocity).force;
        ASSERT_LE(glm::dot(force, velocity), 1e-15);
        work += glm::dot(force, velocity) / kSteps;
      }
      EXPECT_LE(work, 0.0);
    }
  }
}

TEST(ForceField, DensityDragIsThatOfTheValue) {
  const auto field = make_vector_field(std::make_shared<HelixField>(0.0));
  const auto speed = make_speed_field(field);
  const Maker maker = [&](const auto&, const Workspace& workspace) {
    return std::make_unique<DensityDrag>(speed, workspace);
  };
  ProxyChain chain = chain_of(maker, field, 0.05, {.damping = 4.0});
  const double part = (1.0 - speed->lowest()) / (speed->highest() - speed->lowest());
  EXPECT_LT(
      glm::distance(chain.step({0.05, 0.0, 0.0}, {0.1, 0.0, -0.2}).force, -4.0 * part * Vec3(0.1, 0.0, -0.2)),
      1e-14);
}

TEST(ForceField, DensityDragFollowsItsTransferFunction) {
  const auto field = make_vector_field(std::make_shared<HelixField>(0.0));
  ForceFieldSettings settings{.damping = 4.0};
  // Nothing below half of the values, then up to three quarters of the damping.
  ASSERT_EQ(HapticTransferFunction::read("0.5:0,1:0.75", settings.density), std::nullopt);
  ASSERT_TRUE(settings.valid());
  ProxyChain chain = chain_of(kDensity, field, 0.05, settings);
  const auto speed = make_speed_field(field);
  const auto at = [&](double value) {  // the speed at (r, 0, 0) is r
    return chain.step({0.05 * value, 0.0, 0.0}, {0.1, 0.0, 0.0}).force.x;
  };
  const double lowest = speed->lowest(), range = speed->highest() - lowest;
  EXPECT_EQ(at(lowest + 0.4 * range), 0.0);
  EXPECT_NEAR(at(lowest + 0.6 * range), -0.1 * 4.0 * 0.15, 1e-12);
  settings.density = 1.5;
  EXPECT_FALSE(settings.valid());
  settings.density = -0.5;
  EXPECT_FALSE(settings.valid());
}

TEST(ForceField, FeelsTheSameBitForBitOnACellAndOnAGalaxy) {
  const auto flow = example("tornado");
  constexpr int kLength = 70, kSpeed = -33;
  const auto small = make_vector_field(flow), large = make_vector_field(flow, kLength, kSpeed);
  const double scale = 0.1;
  for (const Maker& maker :
       {of_flow<DirectDisplay>(), of_flow<VortexPull>(), of_flow<TransverseDamping>(), kDensity}) {
    ProxyChain a = chain_of(maker, small, scale), b = chain_of(maker, large, scale * std::exp2(-kLength));
    std::mt19937_64 random(4);
    for (int i = 0; i < 200; ++i) {
      const Vec3 probe = scale * random_in(flow->bounds(), random);
      const Vec3 velocity = random_in({Vec3{-0.5}, Vec3{0.5}}, random);
      const Vec3 force = a.step(probe, velocity).force;
      ASSERT_EQ(force, b.step(probe, velocity).force);
      ASSERT_TRUE(is_finite(force));
    }
  }
}

TEST(ForceField, AllocatesNothingInAStep) {
  const auto flow = example("abc");
  const auto field = field_of(sample_tetrahedra(*flow, {8, 8, 8}, 0.2, 1, SampledType::kFloat32));
  for (const Maker& maker :
       {of_flow<DirectDisplay>(), of_flow<VortexPull>(), of_flow<TransverseDamping>(), kDensity}) {
    ProxyChain chain = chain_of(maker, field, 0.02);
    std::mt19937_64 random(5);
    const AllocationGuard guard;
    for (int i = 0; i < 500; ++i)
      (void)chain.step(0.025 * random_in(flow->bounds(), random), {0.1, 0.0, 0.0});
    EXPECT_EQ(guard.count(), 0U);
  }
}

}  // namespace
}  // namespace palpate::test
