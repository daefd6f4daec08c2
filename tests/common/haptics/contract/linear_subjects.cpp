// Linear constraints under the contract: points, lines and planes in frames of every kind, on ways that lead
// through the places where these frames are undefined.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/text.h"
#include "common/haptics/constraint/linear.h"
#include "common/haptics/scalar_frame.h"
#include "common/math/symmetric3.h"
#include "tests/common/haptics/contract/constraint_contract.h"
#include "tests/common/haptics/contract/moved_fields.h"
#include "tests/common/trace/helix_field.h"
#include "tests/common/trace/linear_fields.h"

namespace palpate::test {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kRise = 0.5;  // of helices

std::shared_ptr<Constraint> applied(std::shared_ptr<LinearConstraint> constraint,
                                    const LinearSettings& linear) {
  ChainSettings settings;
  settings.linear = linear;
  constraint->apply(settings);
  return constraint;
}

LinearSettings by_rules(AxisRule one, AxisRule two, AxisRule three, double tau = 0.01) {
  LinearSettings settings;
  settings.axes[0].rule = one;
  settings.axes[1].rule = two;
  settings.axes[2].rule = three;
  for (LinearAxis& axis : settings.axes) axis.tau = tau;
  return settings;
}

Workspace workspace_at(const Placement& at, const LocalFrame& frame) {
  return {power_of_two(-at.exponent), frame};
}

/// Frames that are certain from a speed or a steepness on that is the same in every placement, whose bounds
/// cut off other corners of the field.
std::unique_ptr<FlowFrame> flow_frame(const std::shared_ptr<const VectorField>& field, const Placement& at,
                                      double certain_speed) {
  return std::make_unique<FlowFrame>(field, workspace_at(at, field->frame()),
                                     certain_speed * power_of_two(at.exponent) / field->max_speed());
}

std::unique_ptr<ScalarFrame> scalar_frame(const std::shared_ptr<const ScalarField>& field,
                                          const Placement& at, double certain_steepness,
                                          Tangents tangents = Tangents::kOpen) {
  const double mean = (field->highest() - field->lowest()) / field->diagonal();
  const double steepness = certain_steepness * power_of_two(at.exponent);  // values grow by its square
  return std::make_unique<ScalarFrame>(field, workspace_at(at, field->frame()), Outward::kRising, tangents,
                                       steepness / mean);
}

/// Wandering about the origin, some 0.2 m to each side.
Vec3 wander(double s) {
  return {0.2 * std::sin(9.0 * s), 0.2 * std::cos(14.0 * s), 0.2 * std::sin(11.0 * s + 1.0)};
}

constexpr double kAcross = 0.02;  // drag across directions [m]

/// To and fro past the origin, as straight as a hand goes, at 10 mm, 0.5 mm and 23 um from it.
Vec3 through_the_middle(double s) {
  return {0.25 * std::cos(1.5 * kTurn * s), 0.05 * std::pow(0.1, 4.0 * s), 0.02 * std::sin(5.0 * s)};
}

ContractSubject dragged_point(AxisRule rule) {
  ContractSubject subject;
  subject.name = rule == AxisRule::kDrag ? "LinearDrag" : "LinearSnap";
  subject.make = [rule](const Placement& at) {
    return applied(std::make_shared<LinearConstraint>(std::make_unique<FixedFrame>(at.turned_axes())),
                   by_rules(rule, rule, rule));
  };
  subject.path = wander;
  subject.off_feature = [](const Vec3& probe, const LinkUpdate& link) {
    return std::max(0.0, glm::distance(probe, link.proxy) - 0.01);
  };
  if (rule == AxisRule::kSnap) {
    subject.slope = 2.0;
    subject.leap = 0.01;
  } else {
    subject.smooth_at = {0.3, 0.7};
  }
  return subject;
}

/// A line along the flow of a helix; stiffness and drag along it by the speed there.
ContractSubject follow_a_helix(bool by_speed) {
  ContractSubject subject;
  subject.name = by_speed ? "LinearFollowBySpeed" : "LinearFollow";
  subject.make = [by_speed](const Placement& at) {
    const auto field = moved_flow(std::make_shared<const HelixField>(kRise), at);
    const Workspace workspace = workspace_at(at, field->frame());
    LinearSettings settings = by_rules(AxisRule::kFree, AxisRule::kFixed, AxisRule::kFixed);
    std::array<AxisMeasures, 3> measures;
    if (by_speed) {
      settings.axes[0].rule = AxisRule::kDrag;
      const auto knots = [&](const char* text, const char* more) {
        const double unit = power_of_two(at.exponent);  // speeds grow with the data
        return exact_number(0.5 * unit) + text + exact_number(1.5 * unit) + more;
      };
      EXPECT_FALSE(HapticTransferFunction::read(knots(":0.002,", ":0.02,smooth"), settings.axes[0].tau));
      EXPECT_FALSE(HapticTransferFunction::read(knots(":1,", ":0.25"), settings.axes[1].kappa));
      EXPECT_FALSE(HapticTransferFunction::read(knots(":1,", ":0.25"), settings.axes[2].kappa));
      const auto speed = std::make_shared<SpeedMeasure>(field, workspace);
      measures[0].tau = measures[1].kappa = measures[2].kappa = speed;
    }
    return applied(std::make_shared<LinearConstraint>(flow_frame(field, at, 0.1), measures), settings);
  };
  subject.path = [](double s) {
    const Vec3 along = Helix{.seed = {0.8, 0.0, -0.5}, .rise = kRise}.at_time(0.5 * std::sin(4.0 * s));
    return along + 0.03 * Vec3{std::sin(10.0 * s), std::sin(15.0 * s), std::sin(12.0 * s)};
  };
  subject.off_feature = [by_speed](const Vec3& probe, const LinkUpdate& link) {
    const Vec3 v = HelixField(kRise).velocity(link.proxy);
    const double along = std::abs(glm::dot(probe - link.proxy, glm::normalize(v)));
    return by_speed ? std::max(0.0, along - 0.02) : along;
  };
  subject.slope = 2.0;
  subject.smooth_at = {0.3, 0.6};
  subject.jacobian_error = 0.1;  // stretch times curvature is left out
  subject.moved_error = 1e-8;    // where it settles within 1e-9
  return subject;
}

/// A line along a linear flow, swept across the place where that rests.
ContractSubject across_rest(const char* name, const Mat3& flow) {
  ContractSubject subject;
  subject.name = name;
  subject.make = [flow](const Placement& at) {
    const auto field = moved_flow(std::make_shared<const LinearField>(flow, Vec3{0.0}), at);
    return applied(std::make_shared<LinearConstraint>(flow_frame(field, at, 0.1)),
                   by_rules(AxisRule::kFree, AxisRule::kDrag, AxisRule::kDrag, kAcross));
  };
  subject.path = through_the_middle;
  // Along the flow there is no stretch, and across it no more than the threshold.
  subject.off_feature = [flow](const Vec3& probe, const LinkUpdate& link) {
    const Vec3 v = flow * link.proxy, r = probe - link.proxy;
    const double speed = glm::length(v);
    return std::max(speed > 0.0 ? std::abs(glm::dot(r, v / speed)) : 0.0, glm::length(r) - kAcross);
  };
  // Certain from r_0 = 0.1 m on. Within, thresholds grow by up to 0.02 * 1.5 / r_0 = 0.3 a metre, and
  // directions turn by 1 / r where the thresholds are 0.02 * 3 (r / r_0)^2.
  subject.slope = 3.0;
  subject.moved_error = 1e-7;
  return subject;
}

/// s = (x / a)^2 + (y / b)^2 + (z / c)^2: its isosurface 1 is an ellipsoid.
class Quadric final : public AnalyticScalar {
 public:
  explicit Quadric(const Vec3& size) : inverse_(Vec3{1.0} / size) {}
  [[nodiscard]] double value(const Vec3& x) const noexcept override {
    const Vec3 u = x * inverse_;
    return glm::dot(u, u);
  }
  [[nodiscard]] Jet3 jet(const Vec3& x) const noexcept override {
    const Vec3 square = inverse_ * inverse_;
    Mat3 hessian{0.0};
    for (int a = 0; a < 3; ++a) hessian[a][a] = 2.0 * square[a];
    return {value(x), 2.0 * square * x, hessian};
  }
  [[nodiscard]] Box bounds() const noexcept override { return kMovedBounds; }
  [[nodiscard]] std::string name() const override { return "quadric"; }
  [[nodiscard]] std::string description() const override { return "ellipsoids"; }

 private:
  Vec3 inverse_;
};

/// A surface that is pressed and stroked, with friction that grows with the pressure.
ContractSubject wall_with_friction() {
  ContractSubject subject;
  subject.name = "LinearWallWithFriction";
  subject.make = [](const Placement& at) {
    const auto field = moved_scalars(std::make_shared<const Quadric>(Vec3{0.5}), at);
    LinearSettings settings = by_rules(AxisRule::kUnilateral, AxisRule::kDrag, AxisRule::kDrag, 0.003);
    settings.axes[0].tau = 0.05;
    settings.friction = 0.3;
    return applied(std::make_shared<LinearConstraint>(scalar_frame(field, at, 0.1)), settings);
  };
  subject.path = [](double s) {
    const double along = 2.0 * s, radius = 0.5 + 0.02 * std::cos(20.0 * s);
    return radius * Vec3{std::cos(along), std::sin(along) * std::cos(s), std::sin(along) * std::sin(s)};
  };
  subject.off_feature = [](const Vec3& probe, const LinkUpdate& link) {
    const Vec3 n = glm::normalize(link.proxy), r = probe - link.proxy;
    const double out = glm::dot(r, n), along = glm::length(r - out * n);
    return std::max({out, -out - 0.05, along - (0.003 + 0.3 * std::max(-out, 0.0)), 0.0});
  };
  subject.slope = 2.0;
  subject.moved_error = 1e-8;
  return subject;
}

/// A plane by the gradient, swept through the middle where that vanishes.
ContractSubject plane_across_a_minimum() {
  ContractSubject subject;
  subject.name = "LinearPlaneAcrossAMinimum";
  subject.make = [](const Placement& at) {
    const auto field = moved_scalars(std::make_shared<const Quadric>(Vec3{0.5, 0.7, 0.9}), at);
    return applied(std::make_shared<LinearConstraint>(scalar_frame(field, at, 0.8)),
                   by_rules(AxisRule::kDrag, AxisRule::kFree, AxisRule::kFree, 0.02));
  };
  subject.path = through_the_middle;
  subject.off_feature = [](const Vec3& probe, const LinkUpdate& link) {
    const Vec3 n = glm::normalize(link.proxy / Vec3{0.25, 0.49, 0.81});
    return std::max(0.0, std::abs(glm::dot(probe - link.proxy, n)) - 0.02);
  };
  subject.slope = 3.0;
  subject.moved_error = 1e-7;
  return subject;
}

const Vec3 kEllipsoid{0.2, 0.12, 0.08};

/// Led along the direction of the smaller curvature of an ellipsoid, across the places where both are equal.
ContractSubject along_curvature() {
  ContractSubject subject;
  subject.name = "LinearAlongPrincipalCurvature";
  subject.make = [](const Placement& at) {
    const auto field = moved_scalars(std::make_shared<const Quadric>(kEllipsoid), at);
    LinearSettings settings = by_rules(AxisRule::kFixed, AxisRule::kFree, AxisRule::kDrag, 0.01);
    return applied(std::make_shared<LinearConstraint>(scalar_frame(field, at, 2.0, Tangents::kPrincipal)),
                   settings);
  };
  subject.path = [](double s) {
    const double u = kTurn * s;
    // Both curvatures are equal at x = 0.175, y = 0, z = 0.039, which is u = 0.51.
    return Vec3{0.2 * std::cos(u), 0.01 * std::sin(2.0 * (u - 0.51)), 0.08 * std::sin(u)} * 1.02;
  };
  // Where the directions are certain: across the surface any stretch, along the larger curvature none.
  subject.off_feature = [](const Vec3& probe, const LinkUpdate& link) {
    const Jet3 jet = Quadric(kEllipsoid).jet(link.proxy);
    const double steepness = glm::length(jet.gradient);
    const Vec3 n = jet.gradient / steepness;
    const Mat3 across = Mat3{1.0} - glm::outerProduct(n, n);
    // n itself is made the eigenvector of the least eigenvalue.
    const Mat3 shape = -1.0 / steepness * across * jet.hessian * across - 1e6 * glm::outerProduct(n, n);
    const SymmetricEigen eigen = symmetric_eigen(shape);
    if (eigen.values[0] - eigen.values[1] < ScalarFrame::kCertainCurvature) return 0.0;
    return std::abs(glm::dot(probe - link.proxy, eigen.vectors[0]));
  };
  subject.slope = 8.0;
  subject.moved_error = 1e-7;
  return subject;
}

INSTANTIATE_TEST_SUITE_P(
    Linear, ConstraintContract,
    ::testing::Values(dragged_point(AxisRule::kDrag), dragged_point(AxisRule::kSnap), follow_a_helix(false),
                      follow_a_helix(true),
                      across_rest("LinearFollowAcrossASaddle", rows(1, 0, 0, 0, -1, 0, 0, 0, 0)),
                      across_rest("LinearFollowAcrossAVortex", rows(0, -1, 0, 1, 0, 0, 0, 0, 0)),
                      across_rest("LinearFollowAcrossASource", rows(1, 0, 0, 0, 1, 0, 0, 0, 0)),
                      wall_with_friction(), plane_across_a_minimum(), along_curvature()),
    subject_name);

}  // namespace
}  // namespace palpate::test
