// Both forms of the chain's force, on links whose proxies are known in closed form.

#include "common/haptics/chain_force.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "common/haptics/constraint/anisotropy_drag.h"
#include "tests/common/haptics/straight_links.h"

namespace palpate {
namespace {

using test::chain_of;
using test::FlatPlane;
using test::StraightLine;

constexpr double kStiffness = 200.0;  // N/m, the default

std::vector<std::unique_ptr<Constraint>> line_and_plane(const Vec3& t, const Vec3& n, double plane_kappa) {
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::make_unique<StraightLine>(t));
  links.push_back(std::make_unique<FlatPlane>(n, plane_kappa));
  return links;
}

/// Work of the chain on the hand along `x`(0..1), by the rule of midpoints: exact where F is linear.
double work_along(ProxyChain& chain, const std::function<Vec3(double)>& x, int steps) {
  double work = 0.0;
  for (int n = 0; n < steps; ++n) {
    const Vec3 from = x(static_cast<double>(n) / steps), to = x(static_cast<double>(n + 1) / steps);
    work += glm::dot(chain.step(0.5 * (from + to)).force, to - from);
  }
  return work;
}

/// The rectangle between -a and a along `u` and 0 and s along `t`, from t to u.
std::function<Vec3(double)> rectangle(const Vec3& t, const Vec3& u, double s, double a) {
  return [=](double turn) {
    const double side = 4.0 * turn;
    if (side <= 1.0) return side * s * t - a * u;
    if (side <= 2.0) return s * t + ((side - 1.0) * 2.0 * a - a) * u;
    if (side <= 3.0) return (3.0 - side) * s * t + a * u;
    return (a - (side - 3.0) * 2.0 * a) * u;
  };
}

TEST(ChainForce, AddsOneLinkTheSameInBothForms) {
  for (const ChainForceForm form : {ChainForceForm::kSum, ChainForceForm::kConsistent}) {
    LinkUpdate link;
    link.kappa = {1.0, 0.5, 0.0};
    link.extra_force = {0.0, 0.0, 3.0};
    link.jacobian = Mat3{0.25};
    ChainForce force(form);
    force.add(link, {0.01, 0.02, 0.04}, 100.0);
    EXPECT_EQ(force.force(), Vec3(1.0, 1.0, 3.0)) << name_of(form);
  }
}

// A line at 60 degrees to the normal of a plane. With x = s t + a u (u across the line, towards the normal):
//   p_1 = s t,  f_1 = -k a u,  f_2 = -k' s c n,  n = c t + w u
// The sum is f_1 + f_2; consistent is what of f_2 is along the line: f_1 - k' s c^2 t.
TEST(ChainForce, CarriesThePullOfAPlaneBackAlongTheLine) {
  const double c = 0.5, w = std::sqrt(0.75), s = 0.01, a = 0.002, k2 = 0.4 * kStiffness;
  const Vec3 t{0.0, 0.6, 0.8}, u{0.0, -0.8, 0.6}, n = c * t + w * u;
  const Vec3 probe = s * t + a * u;
  const Vec3 f1 = -kStiffness * a * u, f2 = -k2 * s * c * n;
  auto plain = chain_of(line_and_plane(t, n, 0.4), ChainForceForm::kSum);
  EXPECT_LT(glm::distance(plain.step(probe).force, f1 + f2), 1e-13);
  auto consistent = chain_of(line_and_plane(t, n, 0.4), ChainForceForm::kConsistent);
  EXPECT_LT(glm::distance(consistent.step(probe).force, f1 - k2 * s * c * c * t), 1e-13);
}

// Stokes: the sum has the curl -k' c w in the plane of t and u, so that a rectangle of 2 a by s yields
// 2 a s k' c w one way round and takes it the other way.
TEST(ChainForce, YieldsEnergyOnLoopsOnlyAsASum) {
  const double c = 0.5, w = std::sqrt(0.75), s = 0.02, a = 0.005, k2 = kStiffness;
  const Vec3 t{1.0, 0.0, 0.0}, u{0.0, 1.0, 0.0}, n = c * t + w * u;
  const double yield = 2.0 * a * s * k2 * c * w;
  const auto there = rectangle(t, u, s, a);
  const auto back = [&](double turn) { return there(1.0 - turn); };
  auto plain = chain_of(line_and_plane(t, n, 1.0), ChainForceForm::kSum);
  EXPECT_NEAR(work_along(plain, there, 400), -yield, 1e-12);
  EXPECT_NEAR(work_along(plain, back, 400), yield, 1e-12);
  auto consistent = chain_of(line_and_plane(t, n, 1.0), ChainForceForm::kConsistent);
  EXPECT_NEAR(work_along(consistent, there, 400), 0.0, 1e-15);
  EXPECT_NEAR(work_along(consistent, back, 400), 0.0, 1e-15);
}

// Three links: dp_2 / dx is the product of two Jacobians, the later one on the left.
TEST(ChainForce, MultipliesTheJacobiansInTheOrderOfTheChain) {
  const Vec3 n1 = glm::normalize(Vec3{1.0, 2.0, -1.0}), n2 = glm::normalize(Vec3{0.0, 1.0, 1.0});
  const Vec3 n3 = glm::normalize(Vec3{3.0, -1.0, 0.5});
  std::vector<std::unique_ptr<Constraint>> links;
  for (const Vec3& n : {n1, n2, n3}) links.push_back(std::make_unique<FlatPlane>(n));
  auto chain = chain_of(std::move(links), ChainForceForm::kConsistent);
  // The force is the slope of the energy that the springs hold.
  const auto energy = [&](const Vec3& x) {
    const ChainStep step = chain.step(x);
    double sum = 0.0;
    Vec3 pulled = x;
    for (int i = 0; i < step.links; ++i) {
      const Vec3 stretch = step.proxies[static_cast<std::size_t>(i)] - pulled;
      sum += 0.5 * kStiffness * glm::dot(stretch, stretch);
      pulled = step.proxies[static_cast<std::size_t>(i)];
    }
    return sum;
  };
  const Vec3 x{0.011, -0.004, 0.007};
  const Vec3 force = chain.step(x).force;
  constexpr double kStep = 1e-5;  // m; the energy is quadratic, so the difference is exact
  for (int a = 0; a < 3; ++a) {
    Vec3 step{0.0};
    step[a] = kStep;
    EXPECT_NEAR(force[a], -(energy(x + step) - energy(x - step)) / (2.0 * kStep), 1e-10);
  }
}

// A dragged point takes 2 tau times its pull on a stroke to and fro, a plane gives nothing: in series, too.
TEST(ChainForce, TakesWhatItsLinksTake) {
  const double tau = ChainSettings{}.drag.threshold, s = 0.03;
  const Vec3 along{0.6, 0.8, 0.0};
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::make_unique<IsotropicDrag>());
  links.push_back(std::make_unique<FlatPlane>(Vec3{1.0, 0.0, 0.0}));
  auto chain = chain_of(std::move(links), ChainForceForm::kConsistent);
  const auto stroke = [&](double turn) { return (turn < 0.5 ? 2.0 * turn : 2.0 - 2.0 * turn) * s * along; };
  (void)work_along(chain, stroke, 60000);  // the first one begins with the proxy on the probe
  const double work = work_along(chain, stroke, 60000);
  // Each way the spring is turned over, 2 tau, and then held at k tau for what is left of the way.
  const double taken = 2.0 * kStiffness * tau * (s - 2.0 * tau);
  EXPECT_NEAR(work, -taken, 1e-4 * taken);
}

TEST(ChainForce, PullsNoMoreThanFourTimesAsHardThroughALever) {
  LinkUpdate fast, next;
  fast.jacobian = Mat3{1e6};
  ChainForce force(ChainForceForm::kConsistent);
  force.add(fast, Vec3{0.0}, kStiffness);
  force.add(next, {0.0, 0.003, 0.004}, kStiffness);
  EXPECT_LT(glm::distance(force.force(), Vec3(0.0, 2.4, 3.2)), 1e-12);
}

}  // namespace
}  // namespace palpate
