// Linear constraints where their answers are known: tangents of circles, ramps, borders, places of rest.

#include "common/haptics/constraint/linear.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "common/haptics/scalar_frame.h"
#include "tests/common/haptics/formula_scalars.h"
#include "tests/common/trace/helix_field.h"
#include "tests/common/trace/linear_fields.h"

namespace palpate {
namespace {

using test::helix_flow;
using test::rows;

/// One metre a data unit.
Workspace metres(const LocalFrame& frame) { return {1.0, frame}; }

LinearSettings line_rules(AxisRule across = AxisRule::kFixed, double tau = 0.01) {
  LinearSettings settings;
  for (const int a : {1, 2}) {
    settings.axes[static_cast<std::size_t>(a)].rule = across;
    settings.axes[static_cast<std::size_t>(a)].tau = tau;
  }
  return settings;
}

/// A constraint with its settings and the last answer.
class Held {
 public:
  Held(std::unique_ptr<ReferenceFrame> frame, const LinearSettings& settings,
       std::array<AxisMeasures, 3> measures = {})
      : constraint_(std::move(frame), std::move(measures)) {
    apply(settings);
  }
  void apply(const LinearSettings& linear) {
    ChainSettings settings;
    settings.linear = linear;
    constraint_.apply(settings);
  }
  const LinkUpdate& at(const Vec3& probe, const UpdateBudget& budget = {}) {
    link_ = {};
    constraint_.update(probe, budget, link_);
    pull_ = link_.frame * (link_.kappa * ((link_.proxy - probe) * link_.frame));
    return link_;
  }
  [[nodiscard]] const Vec3& pull() const { return pull_; }  ///< K (p - x) / k [m]

 private:
  LinearConstraint constraint_;
  LinkUpdate link_;
  Vec3 pull_{0.0};
};

Held line_along(const std::shared_ptr<const VectorField>& flow,
                const LinearSettings& settings = line_rules()) {
  return {std::make_unique<FlowFrame>(flow, metres(flow->frame())), settings};
}

// From (1, 0) along the tangents of circles: (1, 0.1), and from there 0.102 / 1.01 of (-0.1, 1).
TEST(Linear, OneIterationIsTheStepOfTheReference) {
  Held held = line_along(helix_flow(0.0));
  const UpdateBudget once{.iterations = 1};
  EXPECT_EQ(held.at({1.0, 0.0, 0.0}, once).proxy, Vec3(1.0, 0.0, 0.0));
  EXPECT_EQ(held.at({1.0, 0.1, 0.0}, once).proxy, Vec3(1.0, 0.1, 0.0));
  const double along = 0.102 / 1.01;
  EXPECT_LE(glm::distance(held.at({0.98, 0.2, 0.0}, once).proxy, Vec3(1.0 - 0.1 * along, 0.1 + along, 0.0)),
            1e-15);
}

/// Radius of the proxy when a probe has gone once round the unit circle in `steps` steps.
double radius_after_a_turn(int steps) {
  Held held = line_along(helix_flow(0.0));
  Vec3 proxy{0.0};
  for (int n = 0; n <= steps; ++n) {
    const double angle = 2.0 * std::numbers::pi * n / steps;
    proxy = held.at({std::cos(angle), std::sin(angle), 0.0}).proxy;
  }
  return glm::length(proxy);
}

// Each step of h goes along a tangent: r^2 grows by sin^2 h, and a turn ends at sqrt(1 + 2 pi h). The
// streamline would end at 1.
TEST(Linear, DriftsOffACurveByTheSecondOrderOfItsSteps) {
  for (const int steps : {500, 1000, 2000}) {
    const double h = 2.0 * std::numbers::pi / steps;
    const double drift = std::sqrt(1.0 + steps * std::sin(h) * std::sin(h)) - 1.0;
    EXPECT_NEAR(radius_after_a_turn(steps) - 1.0, drift, 0.02 * drift) << steps;
  }
}

TEST(Linear, StiffnessAndDragFollowTransferFunctionsOfTheData) {
  const auto ramp = test::scalars<test::Ramp>();  // s = x
  const auto value = std::make_shared<ValueMeasure>(ramp, metres(ramp->frame()));
  LinearSettings settings;
  settings.axes[1].rule = AxisRule::kFixed;
  settings.axes[2].rule = AxisRule::kDrag;
  ASSERT_FALSE(HapticTransferFunction::read("0:1,0.5:0.5", settings.axes[1].kappa));
  ASSERT_FALSE(HapticTransferFunction::read("0:2,0.5:12", settings.axes[2].tau, 1e-3));
  std::array<AxisMeasures, 3> measures;
  measures[1].kappa = measures[2].tau = value;
  Held held(std::make_unique<FixedFrame>(Mat3{1.0}), settings, measures);
  (void)held.at({0.0, 0.0, 0.0});
  for (const double x : {0.0, 0.1, 0.25, 0.4, 0.5, 0.8}) {
    (void)held.at({x, 0.01, 0.0});
    (void)held.at({x, 0.01, 0.1});
    const double part = std::min(x / 0.5, 1.0);
    EXPECT_NEAR(held.pull().y, -0.01 * (1.0 - 0.5 * part), 1e-15) << x;
    EXPECT_NEAR(held.pull().z, -(0.002 + 0.010 * part), 1e-12) << x;
    (void)held.at({x, 0.01, 0.0});
  }
}

// A wall of which x > 0 is the free side: pressed 4 mm deep, 0.5 of that is added to a drag of 1 mm.
TEST(Linear, FrictionGrowsWithThePenetration) {
  const auto ramp = test::scalars<test::Ramp>();
  LinearSettings settings = line_rules(AxisRule::kDrag, 0.001);
  settings.axes[0] = {.rule = AxisRule::kUnilateral, .kappa = 1.0, .tau = 0.02};
  settings.friction = 0.5;
  Held held(std::make_unique<ScalarFrame>(ramp, metres(ramp->frame()), Outward::kRising), settings);
  (void)held.at({0.0, 0.0, 0.0});
  (void)held.at({-0.004, 0.03, 0.04});
  EXPECT_LE(glm::distance(held.pull(), Vec3(0.004, -0.6 * 0.003, -0.8 * 0.003)), 1e-9);
  (void)held.at({0.001, 0.06, 0.08});
  EXPECT_LE(glm::distance(held.pull(), Vec3(0.0, -0.6 * 0.001, -0.8 * 0.001)), 1e-9) << "off the wall";
}

// The flow is straight along x in the cube [-1, 1]^3; the hand pulls 10 mm across it and goes out.
TEST(Linear, LetsGoOverTheFadeDistanceWhereTheDataEnds) {
  const auto flow = test::on_tetrahedra(rows(0, 0, 1, 0, 0, 0, 0, 0, 0), {0.0, 0.0, -2.0}, 5, 0.2, 1);
  Held held = line_along(flow);
  (void)held.at({0.9, 0.0, 0.0});
  (void)held.at({0.9, 0.0, 0.01});
  Vec3 last_pull = held.pull();
  EXPECT_NEAR(glm::length(last_pull), 0.01, 1e-12);
  constexpr double kStep = 1e-5;
  double fell = 0.0;
  for (double x = 0.9; x < 1.1; x += kStep) {
    const LinkUpdate& link = held.at({x, 0.0, 0.01});
    // The reach of a fixed axis, 0.01 w / (1 - w), comes into play below w = 1/2 and falls by 1 / 0.002 a
    // metre.
    ASSERT_LE(glm::distance(held.pull(), last_pull), kStep * (1.0 + 4.0 * 0.01 / 0.002)) << x;
    last_pull = held.pull();
    if (x < 1.0 - kStep) {
      ASSERT_EQ(link.state, HoldState::kHeld) << x;
      ASSERT_NEAR(glm::length(last_pull), 0.01, 1e-12);
    } else if (x < 1.0021 && link.state == HoldState::kFellBack) {
      fell = x;
    } else if (x > 1.0021) {
      ASSERT_EQ(link.state, HoldState::kOutside) << x;
      ASSERT_EQ(last_pull, Vec3{0.0});
    }
  }
  EXPECT_GT(fell, 1.0015) << "it fades over 2 mm";
  for (double x = 1.1; x > 0.9; x -= kStep) {
    const LinkUpdate& link = held.at({x, 0.0, 0.01});
    ASSERT_LE(glm::distance(held.pull(), last_pull), 2.0 * kStep) << "caught where it is, without a pull";
    last_pull = held.pull();
    if (x < 1.0 - kStep) {
      ASSERT_EQ(link.state, HoldState::kHeld) << x;
    }
  }
}

TEST(Linear, HoldsNothingWhereNoDirectionIs) {
  const auto still = test::on_tetrahedra(rows(0, 0, 0, 0, 0, 0, 0, 0, 0), Vec3{0.0}, 5, 0.2, 1);
  Held held = line_along(still);
  for (const Vec3 probe : {Vec3{0.1}, Vec3{0.2, 0.3, -0.1}, Vec3{-0.5}}) {
    EXPECT_EQ(held.at(probe).state, HoldState::kFellBack);
    EXPECT_LE(glm::length(held.pull()), 1e-9);
  }
  const auto flat = test::scalars<test::Flat>();
  Held plane(std::make_unique<ScalarFrame>(flat, metres(flat->frame()), Outward::kRising), line_rules());
  EXPECT_EQ(plane.at(Vec3{0.1}).state, HoldState::kFellBack);
  EXPECT_EQ(plane.at(Vec3{0.2}).proxy, Vec3{0.2});
}

// A tremor of a micrometre, at every distance from the middle of a saddle: the force trembles no more than by
// the bound of the header, wherever the hand rests.
TEST(Linear, DoesNotChatterUnderATremor) {
  const auto saddle = test::on_tetrahedra(rows(1, 0, 0, 0, -1, 0, 0, 0, 0), Vec3{0.0}, 9, 0.2, 1);
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (const double distance : {0.0, 1e-6, 1e-4, 1e-3, 5e-3, 0.01, 0.02, 0.03, 0.1}) {
    Held held = line_along(saddle, line_rules(AxisRule::kDrag, 0.01));
    const Vec3 rest = distance * Vec3{0.6, 0.8, 0.0};
    (void)held.at(rest - Vec3{0.0, 0.0, 0.05});
    Vec3 probe = rest;
    (void)held.at(probe);
    Vec3 last_pull = held.pull();
    for (int n = 0; n < 3000; ++n) {
      const Vec3 next = rest + 1e-6 * Vec3{normal(random), normal(random), normal(random)};
      (void)held.at(next);
      ASSERT_LE(glm::distance(held.pull(), last_pull), 5.0 * glm::distance(next, probe) + 2e-9) << distance;
      probe = next;
      last_pull = held.pull();
    }
  }
}

// Whatever the hand does, no update takes the proxy farther from it; where nothing can be settled it says so.
TEST(Linear, NeverGoesAwayFromTheProbe) {
  Held held = line_along(helix_flow(0.0));
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  Vec3 probe{1.0, 0.0, 0.0};
  Vec3 proxy = held.at(probe).proxy;
  int unsettled = 0;
  for (int n = 0; n < 5000; ++n) {
    probe = glm::clamp(probe + 0.1 * Vec3{normal(random), normal(random), 0.1 * normal(random)}, Vec3{-1.5},
                       Vec3{1.5});
    const double before = glm::distance(probe, proxy);
    const LinkUpdate& link = held.at(probe);
    proxy = link.proxy;
    ASSERT_LE(glm::distance(probe, proxy), before + 1e-12) << n;
    if (link.residual > 1e-9) {
      ++unsettled;
      ASSERT_EQ(link.state, HoldState::kFellBack);
    }
  }
  EXPECT_GT(unsettled, 0);
  EXPECT_LT(unsettled, 2500);
}

// Round a cylinder: the direction of the larger curvature turns with it, and never to the other side.
TEST(ScalarFrame, CarriesDirectionsWithoutSign) {
  const auto cylinder = test::scalars<test::Cylinder>();
  ScalarFrame frame(cylinder, metres(cylinder->frame()), Outward::kFalling, Tangents::kPrincipal, 0.01);
  constexpr double kRadius = 0.05;
  Mat3 last{1.0};
  Mat3 first{1.0};
  constexpr int kSteps = 1000;
  for (int n = 0; n <= kSteps; ++n) {
    const double angle = 2.0 * std::numbers::pi * n / kSteps;
    const Vec3 out{std::cos(angle), std::sin(angle), 0.0};
    const FrameSample sample = frame.at(kRadius * out, last);
    ASSERT_EQ(sample.status, SampleStatus::kOk);
    EXPECT_EQ(sample.certainty, 1.0);
    EXPECT_EQ(sample.split, 1.0) << "20 per metre against none";
    EXPECT_LE(glm::distance(sample.axes[0], -out), 1e-9);
    // Along the gradient, outward, the cylinder curves away by -1/R around, and not at all along: that is
    // more.
    EXPECT_LE(1.0 - std::abs(sample.axes[1].z), 1e-9);
    EXPECT_LE(std::abs(glm::dot(sample.axes[2], out)), 1e-9);
    if (n > 0) {
      for (int a = 0; a < 3; ++a) {
        EXPECT_LE(glm::distance(sample.axes[a], last[a]), 0.01);
      }
    } else {
      first = sample.axes;
    }
    last = sample.axes;
  }
  for (int a = 0; a < 3; ++a) EXPECT_LE(glm::distance(first[a], last[a]), 1e-9) << "back where it began";
}

TEST(ReferenceFrame, IsTurnedTheShortestWay) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const auto any = [&] { return glm::normalize(Vec3{normal(random), normal(random), normal(random)}); };
  for (int n = 0; n < 2000; ++n) {
    const Vec3 a = any(), across = glm::normalize(glm::cross(a, any())), e = any();
    const Mat3 last{a, across, glm::cross(a, across)};
    const Mat3 axes = carried_axes(last, e);
    EXPECT_EQ(axes[0], e);
    EXPECT_NEAR(glm::determinant(axes), 1.0, 1e-12);
    const Vec3 hinge = glm::cross(a, e);
    // What lies along the hinge stays: the coordinates of the hinge are the same in both frames.
    if (1.0 + glm::dot(a, e) > 1e-3) {
      EXPECT_LE(glm::distance(hinge * axes, hinge * last), 1e-9);
    }
    EXPECT_EQ(carried_axes(axes, e), axes);
  }
  const Mat3 opposite = carried_axes(Mat3{1.0}, {-1.0, 0.0, 0.0});
  EXPECT_NEAR(glm::determinant(opposite), 1.0, 1e-12);
}

}  // namespace
}  // namespace palpate
