// What links say of how their proxies move, against differences: the same path again, its last step a little
// aside.

#include <functional>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "common/haptics/constraint/anisotropy_drag.h"
#include "common/haptics/constraint/detent_marks.h"
#include "common/haptics/constraint/streamline.h"
#include "tests/common/trace/helix_field.h"

namespace palpate {
namespace {

using test::Helix;
using test::helix_flow;

constexpr double kAside = 1e-6;  // m; lines and paths below are of the size of one

/// Makes a new constraint each time; what it rests on is kept by the deleter.
using MakeLink = std::function<std::shared_ptr<Constraint>()>;

LinkUpdate last_of(const MakeLink& make, const std::vector<Vec3>& path, const Vec3& aside = Vec3{0.0}) {
  const auto link = make();
  LinkUpdate update;
  for (std::size_t n = 0; n < path.size(); ++n) {
    update = LinkUpdate{};
    link->update(n + 1 < path.size() ? path[n] : path[n] + aside, UpdateBudget{}, update);
  }
  return update;
}

/// Largest difference of a column of J from the central difference of the proxy.
double jacobian_error(const MakeLink& make, const std::vector<Vec3>& path) {
  const Mat3 stated = last_of(make, path).jacobian;
  double worst = 0.0;
  for (int a = 0; a < 3; ++a) {
    Vec3 aside{0.0};
    aside[a] = kAside;
    const Vec3 moved = last_of(make, path, aside).proxy - last_of(make, path, -aside).proxy;
    worst = std::max(worst, glm::distance(stated[a], moved / (2.0 * kAside)));
  }
  return worst;
}

MakeLink drag(double tau) {
  return [tau] {
    ChainSettings settings;
    settings.drag.threshold = tau;
    auto link = std::make_shared<IsotropicDrag>();
    link->apply(settings);
    return link;
  };
}

TEST(LinkJacobian, OfADraggedPoint) {
  const std::vector<Vec3> path{{0.1, 0.2, 0.3}, {0.13, 0.19, 0.34}, {0.2, 0.1, 0.35}};
  EXPECT_LT(jacobian_error(drag(0.03), path), 1e-9) << "dragged";
  EXPECT_EQ(last_of(drag(0.5), path).jacobian, Mat3{0.0}) << "it sticks";
  EXPECT_LT(jacobian_error(drag(0.5), path), 1e-12);
  EXPECT_EQ(last_of(drag(0.0), path).jacobian, Mat3{1.0}) << "it is the probe";
  EXPECT_LT(jacobian_error(drag(0.0), path), 1e-9);
}

/// A helix of radius 1 that rises by 0.5 a radian, traced to 1e-9 of the diagonal.
MakeLink followed(double release) {
  return [release]() -> std::shared_ptr<Constraint> {
    struct Held {
      std::shared_ptr<const VectorField> field = helix_flow(0.5);
      std::shared_ptr<LiveLine> line = std::make_shared<LiveLine>(field, 1e-9, 1);
      StreamlineConstraint constraint{line, Workspace(1.0, field->frame())};
    };
    const auto held = std::make_shared<Held>();
    ChainSettings settings;
    settings.streamline.release_distance = release;
    held->constraint.apply(settings);
    return {held, &held->constraint};
  };
}

/// Along the helix for `turn` radians, and then at `radius` from its axis.
std::vector<Vec3> beside_helix(double turn, double radius) {
  const Helix helix{.rise = 0.5};
  std::vector<Vec3> path;
  constexpr int kSteps = 60;
  for (int n = 0; n <= kSteps; ++n) path.push_back(helix.at_time(turn * n / kSteps));
  path.push_back(path.back() * Vec3{radius, radius, 1.0});
  return path;
}

TEST(LinkJacobian, OfAStreamline) {
  // Curvature 1 / (1 + 0.5^2) = 0.8: on the side of the centre the proxy runs ahead of the probe.
  for (const double radius : {0.4, 0.8, 1.0, 1.2, 1.9}) {
    EXPECT_LT(jacobian_error(followed(1.0), beside_helix(1.3, radius)), 2e-6) << radius;
    const Mat3 jacobian = last_of(followed(1.0), beside_helix(1.3, radius)).jacobian;
    const double pace = jacobian[0][0] + jacobian[1][1] + jacobian[2][2];
    EXPECT_NEAR(pace, 1.0 / (1.0 - 0.8 * (1.0 - radius)), 1e-4) << radius;
  }
  // Let go and caught again by the line through the probe: from now on along that one.
  const std::vector<Vec3> path = beside_helix(1.3, 1.9);
  const LinkUpdate caught = last_of(followed(0.5), path);
  ASSERT_EQ(caught.state, HoldState::kReleased);
  const Vec3 t = glm::normalize(Vec3{-path.back().y, path.back().x, 0.5});
  for (int a = 0; a < 3; ++a) EXPECT_LT(glm::distance(caught.jacobian[a], t[a] * t), 1e-6);
}

TEST(LinkJacobian, OfAStreamlineThatHasEnded) {
  // The field ends at z = 2, at 4 radians: beyond, the proxy stays at the border.
  std::vector<Vec3> path = beside_helix(3.9, 1.0);
  path.push_back(Helix{.rise = 0.5}.at_time(4.1));
  EXPECT_EQ(last_of(followed(1.0), path).jacobian, Mat3{0.0});
  EXPECT_LT(jacobian_error(followed(1.0), path), 1e-9);
}

TEST(LinkJacobian, OfATickMark) {
  const auto field = helix_flow(0.5);
  const auto line = std::make_shared<LiveLine>(field, 1e-9, 1);
  StreamlineConstraint streamline(line, Workspace(1.0, field->frame()));
  TickMarks ticks(streamline);
  ChainSettings settings;
  settings.streamline.release_distance = 1.0;
  const auto update_at = [&](double turn) {
    LinkUpdate first, second;
    streamline.update(Helix{.rise = 0.5}.at_time(turn), UpdateBudget{}, first);
    ticks.update(first.proxy, UpdateBudget{}, second);
    return second;
  };
  streamline.apply(settings);
  ticks.apply(settings);
  EXPECT_EQ(update_at(0.0).jacobian, Mat3{1.0}) << "no marks: the proxy is the probe";
  settings.ticks.interval = 0.2;
  ticks.apply(settings);
  const LinkUpdate here = update_at(0.05), there = update_at(0.06);
  EXPECT_EQ(here.proxy, there.proxy);
  EXPECT_EQ(there.jacobian, Mat3{0.0});
}

}  // namespace
}  // namespace palpate
