// Wall, sphere, circle, segment, polyline and haptic grid under the contract, on ways that lead through the
// places where their nearest point leaps.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/haptics/constraint/detent_marks.h"
#include "common/haptics/constraint/grid_axis.h"
#include "common/haptics/constraint/half_space.h"
#include "common/haptics/constraint/shape.h"
#include "tests/common/haptics/contract/constraint_contract.h"

namespace palpate::test {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kRadius = 0.1;    // of sphere and circle [m]
constexpr double kSpacing = 0.05;  // of grids [m]

template <typename Shape, typename... Arguments>
std::shared_ptr<Constraint> always_held(Arguments&&... arguments) {
  auto shape = std::make_shared<Shape>(std::forward<Arguments>(arguments)...);
  ChainSettings settings;
  settings.shape = {.snap_distance = 1e3, .release_distance = 1e3};
  settings.grid_axis = {.threshold = 0.02, .detents = 0.0};
  shape->apply(settings);
  return shape;
}

/// Straight through the centre, and round about.
Vec3 through_the_middle(double s) {
  if (s < 0.5) return {0.25 - s, 0.0, 0.0};
  const double angle = kTurn * (s - 0.5);
  return {-0.25 * std::cos(angle), 0.25 * std::sin(angle), 0.2 * std::sin(2.0 * angle)};
}

/// In and out of the wall z < 0, and along it.
ContractSubject half_space() {
  ContractSubject subject;
  subject.name = "HalfSpace";
  subject.make = [](const Placement& at) {
    return std::make_shared<HalfSpaceConstraint>(at.point(Vec3{0.0}), at.direction({0.0, 0.0, 3.0}));
  };
  subject.path = [](double s) { return Vec3{s, 0.1 * s, 0.05 * std::cos(3.0 * kTurn * s) - 0.01}; };
  subject.off_feature = [](const Vec3& probe, const LinkUpdate& link) {
    return glm::distance(link.proxy, Vec3{probe.x, probe.y, std::max(probe.z, 0.0)});
  };
  subject.smooth_at = {0.05, 0.16, 0.3, 0.5};
  return subject;
}

ContractSubject sphere() {
  ContractSubject subject;
  subject.name = "Sphere";
  subject.make = [](const Placement& at) {
    return always_held<SphereConstraint>(at.point(Vec3{0.0}), kRadius);
  };
  subject.path = through_the_middle;
  subject.off_feature = [](const Vec3&, const LinkUpdate& link) {
    return std::abs(glm::length(link.proxy) - kRadius);
  };
  // f = kappa (R - r) n: |df/dr| <= |kappa'| R + 1 with kappa' <= 1.5 / (R / 4), and kappa R / r across.
  subject.slope = 7.0;
  subject.smooth_at = {0.1, 0.23, 0.7};
  return subject;
}

ContractSubject circle() {
  ContractSubject subject;
  subject.name = "Circle";
  subject.make = [](const Placement& at) {
    return always_held<CircleConstraint>(at.point(Vec3{0.0}), at.direction({0.0, 0.0, 2.0}), kRadius);
  };
  subject.path = through_the_middle;
  subject.off_feature = [](const Vec3&, const LinkUpdate& link) {
    return std::hypot(std::hypot(link.proxy.x, link.proxy.y) - kRadius, link.proxy.z);
  };
  subject.slope = 8.0;  // that of the sphere, and 1 along the normal
  subject.smooth_at = {0.1, 0.23, 0.7};
  return subject;
}

ContractSubject detents() {
  constexpr int kMarks = 9;
  const auto mark = [](int i) { return Vec3{0.03 * i - 0.12, 0.02, 0.0}; };
  ContractSubject subject;
  subject.name = "Detents";
  subject.make = [=](const Placement& at) {
    std::vector<Vec3> marks;
    for (int i = 0; i < kMarks; ++i) marks.push_back(at.point(mark(i)));
    return std::make_shared<DetentMarks>(marks, 0.015);
  };
  // Along the marks and a little beside them.
  subject.path = [](double s) {
    return Vec3{0.11 * std::sin(kTurn * s), 0.02 + 0.003 * std::sin(20.0 * s), 0.003 * std::cos(30.0 * s)};
  };
  subject.off_feature = [=](const Vec3&, const LinkUpdate& link) {
    double least = HUGE_VAL;
    for (int i = 0; i < kMarks; ++i) least = std::min(least, glm::distance(link.proxy, mark(i)));
    return least;
  };
  subject.smooth_at = {0.01, 0.13, 0.4};
  return subject;
}

double from_segment(const Vec3& x, const Vec3& a, const Vec3& b) {
  // By the sides of a triangle: its height, or the shorter side where an angle at the base is obtuse.
  const double base = glm::distance(a, b), left = glm::distance(x, a), right = glm::distance(x, b);
  if (left * left > right * right + base * base || right * right > left * left + base * base)
    return std::min(left, right);
  return glm::length(glm::cross(x - a, x - b)) / base;
}

ContractSubject segment() {
  const Vec3 a{-0.1, -0.05, 0.0}, b{0.1, 0.05, 0.1};
  ContractSubject subject;
  subject.name = "Segment";
  subject.make = [=](const Placement& at) {
    return always_held<PolylineConstraint>(at.point(a), at.point(b));
  };
  subject.path = [](double s) {
    return Vec3{0.3 * std::sin(kTurn * s), 0.1 * std::cos(2.0 * kTurn * s), 0.2 * std::sin(3.0 * kTurn * s)};
  };
  subject.off_feature = [=](const Vec3&, const LinkUpdate& link) { return from_segment(link.proxy, a, b); };
  subject.slope = 1.0;  // x - p of a convex set moves no farther than x
  subject.smooth_at = {0.05, 0.25, 0.52};
  return subject;
}

ContractSubject polyline() {
  const std::vector<Vec3> vertices{{-0.2, 0.0, 0.0}, {-0.1, 0.1, 0.0}, {0.0, 0.0, 0.05}, {0.0, 0.0, 0.05},
                                   {0.1, 0.1, 0.1},  {0.2, 0.0, 0.0},  {0.3, 0.1, 0.0}};
  ContractSubject subject;
  subject.name = "Polyline";
  subject.make = [=](const Placement& at) {
    std::vector<Vec3> moved;
    for (const Vec3& v : vertices) moved.push_back(at.point(v));
    return always_held<PolylineConstraint>(moved);
  };
  // Along the line and beside it by less than its bends' own reach, past both ends, and back.
  subject.path = [=](double s) {
    const double t = 3.5 - 4.0 * std::cos(kTurn * s);
    const auto at = static_cast<std::size_t>(std::clamp(std::floor(t), 0.0, 5.0));
    const Vec3 along = vertices[at] + (t - static_cast<double>(at)) * (vertices[at + 1] - vertices[at]);
    return along + 0.01 * Vec3{std::sin(40.0 * s), std::cos(50.0 * s), std::sin(60.0 * s)};
  };
  subject.off_feature = [=](const Vec3&, const LinkUpdate& link) {
    double least = HUGE_VAL;
    for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
      if (vertices[i] != vertices[i + 1])
        least = std::min(least, from_segment(link.proxy, vertices[i], vertices[i + 1]));
    }
    return least;
  };
  subject.slope = 2.0;
  subject.leap = 0.04;  // round a bend it changes over from one segment to the next, both 0.02 away at most
  subject.smooth_at = {0.2, 0.3};
  return subject;
}

/// To and fro along the axes of a grid, from node to node.
Vec3 along_axes(double s) {
  const double u = 8.0 * s, step = u - std::floor(u);
  const Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {1, 2, 1}, {0, 2, 1},
                          {0, 0, 1}, {0, 0, 0}, {0, 0, 2}, {0, 0, 0}};
  const auto at = static_cast<std::size_t>(std::min(std::floor(u), 7.0));
  const double t = at == 7 && u >= 8.0 ? 1.0 : step;
  const Vec3 wobble = 0.005 * Vec3{std::sin(30.0 * s), std::sin(40.0 * s), std::cos(50.0 * s)};
  return kSpacing * (corners[at] + t * (corners[at + 1] - corners[at])) + wobble;
}

ContractSubject grid_axis(bool detents) {
  ContractSubject subject;
  subject.name = detents ? "GridAxisWithTeeth" : "GridAxis";
  subject.make = [detents](const Placement& at) {
    auto grid = std::make_shared<GridAxis>(at.point(Vec3{0.0}), at.rotation, Vec3{kSpacing});
    ChainSettings settings;
    settings.grid_axis = {.threshold = 0.02, .detents = detents ? 0.5 : 0.0};
    grid->apply(settings);
    return grid;
  };
  subject.path = along_axes;
  subject.off_feature = [](const Vec3&, const LinkUpdate& link) {
    // Two coordinates lie on nodes.
    Vec3 off = glm::abs(link.proxy / kSpacing - glm::round(link.proxy / kSpacing));
    const double most = std::max({off.x, off.y, off.z});
    return kSpacing * (off.x + off.y + off.z - most);
  };
  subject.slope = 2.0;
  subject.leap = detents ? kSpacing * std::numbers::sqrt3 : 0.03;  // an axis takes over at 0.02 of pull
  subject.smooth_at = {0.06, 0.2};
  return subject;
}

INSTANTIATE_TEST_SUITE_P(Shapes, ConstraintContract,
                         ::testing::Values(half_space(), sphere(), circle(), segment(), polyline(), detents(),
                                           grid_axis(false), grid_axis(true)),
                         subject_name);

}  // namespace
}  // namespace palpate::test
