// The cutting-plane widget: every transition of its table, planes put where three points say, and axes that
// stay orthonormal. What the hand feels of transitions: plane_widget_force_test.cpp.

#include "common/haptics/widget/plane_widget.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/haptics/widget/widget_text.h"
#include "tests/common/haptics/widget/widget_bench.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/project_folders.h"

namespace palpate::test {
namespace {

constexpr double kRadius = 0.025, kReach = 0.008;  // defaults [m]
constexpr double kDegrees = std::numbers::pi / 180.0;

const Vec3 kFarAway{0.1, 0.0, 0.05}, kAtPlane{0.1, 0.0, 0.002}, kAtSphere{0.013, 0.010, 0.020};

/// Brings the widget into `state`.
void enter(Bench& bench, WidgetState state) {
  (void)bench.at(kFarAway);
  const bool sphere = state == WidgetState::kOnSphere || state == WidgetState::kRotate;
  if (state == WidgetState::kFree) return;
  (void)bench.at(sphere ? kAtSphere : kAtPlane);
  if (state == WidgetState::kTranslate || state == WidgetState::kRotate)
    (void)bench.at(sphere ? kAtSphere : kAtPlane, true);
}

/// Lets `event` happen.
void happen(Bench& bench, WidgetState state, WidgetEvent event) {
  const bool down = state == WidgetState::kTranslate || state == WidgetState::kRotate;
  const Vec3 stay = state == WidgetState::kFree                                          ? kFarAway
                    : state == WidgetState::kOnPlane || state == WidgetState::kTranslate ? kAtPlane
                                                                                         : kAtSphere;
  switch (event) {
    case WidgetEvent::kNearPlane:
      (void)bench.at(kAtPlane, down);
      break;
    case WidgetEvent::kNearSphere:
      (void)bench.at(kAtSphere, down);
      break;
    case WidgetEvent::kFar:
      (void)bench.at(kFarAway, down);
      break;
    case WidgetEvent::kPress:
      (void)bench.at(stay, true);
      break;
    case WidgetEvent::kRelease:
      (void)bench.at(stay, false);
      break;
    case WidgetEvent::kLost:
      bench.chain().reset();
      break;
  }
}

TEST(PlaneWidgetStates, AreThoseOfTheTable) {
  for (int s = 0; s < kWidgetStateCount; ++s) {
    for (int e = 0; e < kWidgetEventCount; ++e) {
      const auto state = static_cast<WidgetState>(s);
      const auto event = static_cast<WidgetEvent>(e);
      Bench bench;
      enter(bench, state);
      ASSERT_EQ(bench.widget().state(), state) << name_of(state);
      happen(bench, state, event);
      EXPECT_EQ(bench.widget().state(), state_after(state, event))
          << name_of(state) << " and " << name_of(event) << " gave " << name_of(bench.widget().state());
    }
  }
}

TEST(PlaneWidgetStates, AreThoseOfTheDocumentation) {
  std::ifstream file(source_folder() / "common/haptics/widget/README.md");
  std::vector<std::string> told, known;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string bar, from, event, to;
    if (words >> bar >> from >> bar >> event >> bar >> to && event.starts_with('`') && to.starts_with('`'))
      told.push_back(from + event + to);
  }
  for (const WidgetTransition& each : kWidgetTransitions) {
    known.push_back("`" + std::string(name_of(each.from)) + "``" + std::string(name_of(each.event)) + "``" +
                    std::string(name_of(each.to)) + "`");
  }
  EXPECT_EQ(told, known);
}

TEST(PlaneWidget, MovesAlongTheAxisOfThePullAlone) {
  Bench bench;
  enter(bench, WidgetState::kTranslate);
  bench.put(kAtPlane);
  (void)bench.lead(kAtPlane + Vec3(0.003, -0.005, 0.040), true);
  (void)bench.lead(kAtPlane + Vec3(-0.002, 0.004, 0.030), true);
  const Vec3 center = bench.widget().pose(0).center;
  EXPECT_EQ(center.x, 0.0) << "to the bit";
  EXPECT_EQ(center.y, 0.0);
  EXPECT_NEAR(center.z, 0.032, 1e-15) << "from the grip on the plane";
  // Two pulls, no plane but one.
  (void)bench.lead(kAtPlane + Vec3(0.020, 0.004, 0.030), true);
  EXPECT_NEAR(bench.widget().pose(0).center.x, 0.020, 1e-15);
  EXPECT_EQ(bench.widget().pose(0).center.y, 0.0);
  // And back within reach: the axis is as it was.
  (void)bench.lead(kAtPlane + Vec3(0.001, 0.004, 0.030), true);
  EXPECT_EQ(bench.widget().pose(0).center.x, 0.0);
  EXPECT_EQ(axes_of(bench.widget().pose(0)), Mat3{1.0});
}

TEST(PlaneWidget, TurnsAboutAnAxisFromAGreatCircle) {
  Bench bench;
  // On the circle of plane x = 0, 40 degrees up; led on by 30 degrees and off the circle.
  const auto on_circle = [](double degrees, double off) {
    return Vec3(off, (kRadius + 0.001) * std::cos(degrees * kDegrees),
                (kRadius + 0.001) * std::sin(degrees * kDegrees));
  };
  bench.put({0.1, 0.1, 0.1});
  (void)bench.lead(on_circle(40.0, 0.001), false);
  (void)bench.lead(on_circle(40.0, 0.001), true);
  for (int d = 0; d <= 30; ++d) (void)bench.lead(on_circle(40.0 + d, 0.005), true);
  const Mat3 axes = axes_of(bench.widget().pose(0));
  EXPECT_NEAR(axes[0].x, 1.0, 1e-15) << "about x alone";
  EXPECT_NEAR(std::atan2(-axes[2].y, axes[2].z), 30.0 * kDegrees, 1e-12);
  // Pulled off the circle it turns freely.
  Vec3 away = on_circle(70.0, 0.0);
  away = kRadius * glm::normalize(away + Vec3(0.02, 0.0, 0.0));
  (void)bench.lead(away, true);
  EXPECT_LT(std::abs(axes_of(bench.widget().pose(0))[0].x), 0.999);
}

TEST(PlaneWidget, HasDetentsAtItsStepsAndAtTheAxes) {
  Bench bench(15.0);
  const auto on_circle = [](double degrees) {
    return kRadius * Vec3(0.0, std::cos(degrees * kDegrees), std::sin(degrees * kDegrees));
  };
  bench.put({0.1, 0.1, 0.1});
  (void)bench.lead(on_circle(40.0), false);
  (void)bench.lead(on_circle(40.0), true);
  for (double d = 0.0; d <= 46.4; d += 0.2) (void)bench.lead(on_circle(40.0 + d), true);
  const Mat3 axes = axes_of(bench.widget().pose(0));
  EXPECT_NEAR(std::atan2(-axes[2].y, axes[2].z), 45.0 * kDegrees, 1e-14) << "the very step";

  // Freely, to two degrees before an axis of the data that lies askew.
  const Vec3 askew = glm::normalize(Vec3(1.0, 1.0, 1.0)), u = glm::normalize(Vec3(1.0, 1.0, 0.0));
  const Mat3 data_axes{glm::normalize(Vec3(1.0, -1.0, 0.0)),
                       glm::cross(askew, glm::normalize(Vec3(1.0, -1.0, 0.0))), askew};
  for (const double short_of : {2.0, 4.0}) {
    Bench free(15.0, data_axes);
    const auto on_sphere = [&](double angle) {
      return kRadius * (std::cos(angle) * u + std::sin(angle) * Vec3(0.0, 0.0, 1.0));
    };
    free.put({0.1, 0.1, 0.1});
    (void)free.lead(on_sphere(0.8), false);
    (void)free.lead(on_sphere(0.8), true);
    const double angle = std::acos(askew.z) - short_of * kDegrees;
    for (int i = 0; i <= 400; ++i) (void)free.lead(on_sphere(0.8 - angle * i / 400.0), true);
    const double off = glm::distance(axes_of(free.widget().pose(0))[2], askew);
    if (short_of < 3.0) {
      EXPECT_LT(off, 1e-14) << "the very axis";
    } else {
      EXPECT_NEAR(off, short_of * kDegrees, 1e-3) << "out of its reach";
    }
  }
}

TEST(PlaneWidget, StaysOrthonormalAfterAMillionIncrements) {
  Bench bench(15.0);
  std::mt19937 random{5};
  std::normal_distribution<double> normal;
  (void)bench.at(kFarAway);
  bool down = false;
  for (int n = 0; n < 1'000'000; ++n) {
    const Vec3 x = kRadius * glm::normalize(Vec3(normal(random), normal(random), normal(random)));
    if (n % 3 == 0) down = !down;
    (void)bench.at(x, down);
  }
  const Mat3 axes = axes_of(bench.widget().pose(0));
  const Mat3 product = glm::transpose(axes) * axes;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) EXPECT_NEAR(product[a][b], a == b ? 1.0 : 0.0, 4e-16 * 4);
  }
  EXPECT_NEAR(glm::determinant(axes), 1.0, 4e-15);
}

TEST(PlaneWidget, GoesThroughThreePoints) {
  std::mt19937 random{3};
  std::uniform_real_distribution<double> place{-0.05, 0.05};
  for (int run = 0; run < 50; ++run) {
    Vec3 points[3];
    for (Vec3& each : points) each = {place(random), place(random), place(random)};
    Vec3 n = glm::cross(points[1] - points[0], points[2] - points[0]);
    if (glm::length(n) < 1e-4) continue;
    n = glm::normalize(n);
    if (n.z < 0.0) n = -n;
    Bench bench;
    // Turn z into n by a grip off the three circles, led by the same turn, then pull along n and across.
    const Vec3 axis = glm::cross(Vec3(0.0, 0.0, 1.0), n);
    if (glm::length(axis) < 0.1) continue;
    const Vec3 k = glm::normalize(axis);
    const double angle = std::acos(n.z);
    // A place at right angles to the axis of the turn goes the shortest way.
    const Vec3 across = glm::cross(k, Vec3(0.0, 0.0, 1.0));
    const auto turned = [&](double by) {
      return kRadius * (std::cos(0.8 + by) * across + std::sin(0.8 + by) * Vec3(0.0, 0.0, 1.0));
    };
    if (std::min(std::abs(turned(0.0).x), std::abs(turned(0.0).y)) < kReach) continue;
    const double sense = glm::dot(glm::cross(across, Vec3(0.0, 0.0, 1.0)), k) > 0.0 ? 1.0 : -1.0;
    bench.put({0.1, 0.1, 0.1});
    (void)bench.lead(turned(0.0), false);
    (void)bench.lead(turned(0.0), true);
    (void)bench.lead(turned(sense * angle), true);
    (void)bench.lead(turned(sense * angle), false);
    ASSERT_LT(glm::distance(axes_of(bench.widget().pose(0))[2], n), 1e-12);
    // Take the plane where it is far from the sphere, and pull it over.
    const Vec3 grip = 0.06 * glm::normalize(glm::cross(n, Vec3(1.0, 0.3, 0.2)));
    (void)bench.lead(0.2 * n, false);
    (void)bench.lead(grip + 0.05 * n, false);
    (void)bench.lead(grip, false);
    (void)bench.lead(grip, true);
    ASSERT_EQ(bench.widget().state(), WidgetState::kTranslate);
    const double d = glm::dot(n, points[0]);
    (void)bench.lead(grip + (d + std::copysign(0.02, d)) * n, true);
    if (std::abs(d) < kReach) continue;  // within reach a pull along n does nothing
    (void)bench.lead(grip + d * n, true);
    const PlanePose& pose = bench.widget().pose(0);
    for (const Vec3& each : points)
      EXPECT_LT(std::abs(glm::dot(axes_of(pose)[2], each - pose.center)), 1e-12);
  }
}

TEST(PlaneWidget, TakesPlanesThatAreTypedIn) {
  Bench bench;
  enter(bench, WidgetState::kTranslate);
  ChainSettings settings = bench.settings();
  settings.plane_widget.poses.count = 1;
  settings.plane_widget.poses.pose[0] = pose_of_plane({0.0, 1.0, 0.0}, 0.01, Vec3{0.0});
  bench.chain().apply(settings);
  EXPECT_EQ(bench.widget().state(), WidgetState::kTranslate) << "nothing was typed in: the same edit";
  ++settings.plane_widget.edit;
  bench.chain().apply(settings);
  EXPECT_EQ(bench.widget().state(), WidgetState::kFree);
  EXPECT_NEAR(axes_of(bench.widget().pose(0))[2].y, 1.0, 1e-15);
  EXPECT_NEAR(bench.widget().pose(0).center.y, 0.01, 1e-15);
}

// A session that is opened and saved again is the same to the bit.
TEST(PlaneWidget, TellsPlanesThatNobodyMovesAsTheyWerePut) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int trial = 0; trial < 1000; ++trial) {
    ChainSettings settings;
    settings.plane_widget.poses.count = 1;
    PlanePose& put = settings.plane_widget.poses.pose[0];
    const Vec3 normal = glm::normalize(Vec3{uniform(random), uniform(random), uniform(random)});
    put = turned_to({.center = 100.0 * Vec3{uniform(random), uniform(random), uniform(random)}}, normal);
    Bench bench(settings, Mat3{1.0}, 0.25 / (1.0 + std::abs(uniform(random))));
    EXPECT_EQ(bench.news().poses, settings.plane_widget.poses) << trial;
  }
}

TEST(PlaneWidget, StepAllocatesNothing) {
  Bench bench(15.0);
  const AllocationGuard guard;
  for (int n = 0; n < 2000; ++n)
    (void)bench.at({0.03 * std::sin(0.01 * n), 0.02 * std::cos(0.013 * n), 0.01}, n % 300 > 150);
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace palpate::test
