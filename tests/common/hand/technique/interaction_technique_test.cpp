// A mouse and tracked hands behind one interface: each takes what its devices say, and leaves the rest.

#include "common/hand/technique/interaction_technique.h"

#include <random>

#include <gtest/gtest.h>

#include "common/hand/technique/immersive_technique.h"

namespace palpate {
namespace {

HandsView view() {
  return {.camera = make_camera({Vec3{-1.0}, Vec3{1.0}}, {}, 1.5), .size = {300, 200}, .held = std::nullopt};
}

/// A workbench whose tracker is turned a quarter about x, with a stylus of 100 mm and a tracker that is 5 mm off.
WorkbenchGeometry workbench(double gain) {
  WorkbenchGeometry out;
  out.interaction = {true, {0.5, 0.1, -0.2}, rotation_by({0.5 * 3.14159265358979323846, 0.0, 0.0}), gain};
  out.stylus = Vec3{0.0, 0.0, -0.1};
  out.tracker.emplace();
  out.tracker->position = {.degree = 0, .center = Vec3{0.0}, .scale = 1.0, .coefficients = {{0.005, 0, 0}}};
  out.tracker->orientation = {.degree = 0, .center = Vec3{0.0}, .scale = 1.0, .coefficients = {Vec3{0.0}}};
  return out;
}

TrackedHands stylus(const Vec3& place, const Quat& turn = identity_rotation()) {
  return {.stylus = TrackerPose{place, turn}};
}

TEST(InteractionTechnique, EachLeavesWhatIsNotItsOwn) {
  DesktopTechnique desktop;
  ImmersiveTechnique immersive(workbench(1.0), Vec3{0.0}, 1.0);
  for (InteractionTechnique* each :
       {static_cast<InteractionTechnique*>(&desktop), static_cast<InteractionTechnique*>(&immersive)}) {
    const bool mouse = each == &desktop;
    EXPECT_EQ(each->take(MouseDrag{5.0, 3.0}, view()), mouse);
    EXPECT_EQ(each->take(WheelTurn{1.0}, view()), mouse);
    EXPECT_EQ(each->take(AxisLock{1}, view()), mouse);
    EXPECT_EQ(each->take(stylus(Vec3{0.0}), view()), !mouse);
    each->put({1.0, 2.0, 3.0});
    EXPECT_EQ(each->intent().probe, Vec3(1.0, 2.0, 3.0));
  }
}

TEST(DesktopTechnique, MovesAsTheMouseDoes) {
  DesktopTechnique desktop;
  HandsView seen = view();
  desktop.put({0.1, 0.2, 0.3});
  (void)desktop.take(MouseDrag{20.0, -7.0}, seen);
  const Vec3 first = dragged(seen.camera, seen.size, {0.1, 0.2, 0.3}, 20.0, -7.0, std::nullopt);
  EXPECT_EQ(desktop.intent().probe, first);
  (void)desktop.take(WheelTurn{2.0}, seen);
  const Vec3 second = pushed(seen.camera, first, 2.0, std::nullopt);
  EXPECT_EQ(desktop.intent().probe, second);
  // From the proxy's depth while something holds it; along a locked axis from where it is.
  seen.held = Vec3{0.4, 0.1, -0.2};
  (void)desktop.take(MouseDrag{1.0, 1.0}, seen);
  const Vec3 third =
      dragged(seen.camera, seen.size, at_depth_of(seen.camera, second, *seen.held), 1.0, 1.0, std::nullopt);
  EXPECT_EQ(desktop.intent().probe, third);
  (void)desktop.take(AxisLock{0}, seen);
  (void)desktop.take(MouseDrag{30.0, 11.0}, seen);
  EXPECT_NE(desktop.intent().probe.x, third.x);
  EXPECT_EQ(desktop.intent().probe.y, third.y) << "to the bit";
  EXPECT_EQ(desktop.intent().probe.z, third.z);
}

TEST(ImmersiveTechnique, TakesTheTipThroughTheCalibration) {
  constexpr double kScale = 0.002;  // metres of the workspace per data unit
  const Vec3 middle{50.0, 40.0, 80.0};
  ImmersiveTechnique hands(workbench(2.0), middle, kScale);
  // The tip in the middle of the workbench: 5 mm less for the tracker, and the stylus pointing along x.
  const Quat along_x = rotation_by({0.0, -0.5 * 3.14159265358979323846, 0.0});
  ASSERT_LT(glm::distance(along_x * Vec3(0.0, 0.0, -0.1), Vec3(0.1, 0.0, 0.0)), 1e-15);
  const Vec3 sensor = Vec3(0.5, 0.1, -0.2) - Vec3(0.1, 0.0, 0.0) - Vec3(0.005, 0.0, 0.0);
  (void)hands.take(stylus(sensor, along_x), {});
  EXPECT_LT(glm::distance(hands.intent().probe, middle), 1e-10);
  // 10 mm up the tracker's y: z of the data, twice as far in the workspace, 500 units a metre.
  (void)hands.take(stylus(sensor + Vec3(0.0, 0.01, 0.0), along_x), {});
  EXPECT_LT(glm::distance(hands.intent().probe, middle + Vec3(0.0, 0.0, 10.0)), 1e-10);
  EXPECT_FALSE(hands.intent().acts);
}

TEST(ImmersiveTechnique, TheClutchMovesTheHandAndNotTheProbe) {
  ImmersiveTechnique hands(workbench(1.0), Vec3{0.0}, 1.0);
  (void)hands.take(stylus({0.5, 0.1, 0.0}), {});
  const Vec3 before = hands.intent().probe;
  TrackedHands away = stylus({0.9, -0.4, 0.3});
  away.clutch = true;
  (void)hands.take(away, {});
  EXPECT_EQ(hands.intent().probe, before) << "to the bit";
  away.clutch = false;
  (void)hands.take(away, {});
  EXPECT_LT(glm::distance(hands.intent().probe, before), 1e-15) << "no leap where it is let go";
  away.stylus->position += Vec3{0.01, 0.0, 0.0};
  (void)hands.take(away, {});
  EXPECT_LT(glm::distance(hands.intent().probe, before + Vec3(0.01, 0.0, 0.0)), 1e-15);
  // Out of sight it stays.
  away.stylus.reset();
  (void)hands.take(away, {});
  EXPECT_LT(glm::distance(hands.intent().probe, before + Vec3(0.01, 0.0, 0.0)), 1e-15);
}

/// Whatever the other hand does, what it carries keeps its place and turn in that hand.
TEST(ImmersiveTechnique, TheOtherHandCarriesAPlaneRigidly) {
  std::mt19937 random{4};
  std::uniform_real_distribution<double> any{-1.0, 1.0};
  const auto vector = [&] { return Vec3{any(random), any(random), any(random)}; };
  for (int run = 0; run < 50; ++run) {
    WorkbenchGeometry geometry = workbench(0.5 + run * 0.05);
    ImmersiveTechnique hands(geometry, vector(), 0.01);
    CarriedPlanes carried;
    WidgetNews news;
    news.poses.count = 3;
    news.current = run % 3;
    for (int i = 0; i < 3; ++i)
      news.poses.pose[static_cast<std::size_t>(i)] =
          turned_to({.center = 20.0 * vector()}, glm::normalize(vector()));
    const PlanePose held = news.poses.pose[static_cast<std::size_t>(news.current)];
    TrackedHands now{.other = TrackerPose{vector(), rotation_by(2.0 * vector())}, .carries = true};
    (void)hands.take(now, {});
    const Rigid grip{geometry.interaction.rotation * now.other->orientation, Vec3{0.0}};
    EXPECT_FALSE(carried.follow(hands.intent(), news)) << "nothing has moved";
    const Vec3 start = now.other->position;
    PlanePoses last = news.poses;
    for (int n = 0; n < 20; ++n) {
      now.other = TrackerPose{start + 0.1 * vector(), rotation_by(vector())};
      (void)hands.take(now, {});
      const auto poses = carried.follow(hands.intent(), news);
      ASSERT_TRUE(poses);
      last = *poses;
      const PlanePose& moved = last.pose[static_cast<std::size_t>(news.current)];
      ASSERT_TRUE(moved.valid());
      // The normal as the hand sees it.
      const Quat turn = geometry.interaction.rotation * now.other->orientation;
      const Vec3 seen = glm::conjugate(turn) * axes_of(moved)[2];
      EXPECT_LT(glm::distance(seen, glm::conjugate(grip.rotation) * axes_of(held)[2]), 1e-14);
    }
    // Back where it took hold, so is the plane; the others never moved.
    now.other = TrackerPose{start, glm::conjugate(geometry.interaction.rotation) * grip.rotation};
    (void)hands.take(now, {});
    const auto poses = carried.follow(hands.intent(), news);
    ASSERT_TRUE(poses);
    for (int i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(i);
      EXPECT_LT(glm::distance(poses->pose[at].center, news.poses.pose[at].center),
                i == news.current ? 1e-11 : 1e-300);
    }
    now.carries = false;
    (void)hands.take(now, {});
    EXPECT_FALSE(carried.follow(hands.intent(), news));
  }
}

// The picture of the tip is off by the offset, turned and enlarged as the data is, and stays on the surface.
TEST(ImmersiveTechnique, ShowsTheTipBesideTheHandAndOnASurface) {
  WorkbenchGeometry file = workbench(2.0);
  constexpr double kScale = 0.25;  // [m] a data unit
  ImmersiveTechnique plain(file, Vec3{1.0, 2.0, 3.0}, kScale);
  file.interaction.tip_offset = {0.01, -0.02, 0.03};
  ImmersiveTechnique beside(file, Vec3{1.0, 2.0, 3.0}, kScale);
  const Vec3 n = glm::normalize(Vec3(0.3, 1.0, -0.2));
  file.interaction.surface = Vec4(n, 0.04);
  ImmersiveTechnique on_surface(file, Vec3{1.0, 2.0, 3.0}, kScale);
  std::mt19937_64 random(29);
  std::uniform_real_distribution<double> anywhere(-0.3, 0.3);
  const WorkbenchPlace place = place_of(file.interaction, Vec3{1.0, 2.0, 3.0}, kScale);
  for (int i = 0; i < 50; ++i) {
    const Vec3 q{anywhere(random), anywhere(random), anywhere(random)};
    const TrackedHands hands = stylus(q, rotation_by({anywhere(random), anywhere(random), anywhere(random)}));
    for (ImmersiveTechnique* each : {&plain, &beside, &on_surface}) ASSERT_TRUE(each->take(hands, {}));
    const Vec3 offset = 2.0 / kScale * (file.interaction.rotation * file.interaction.tip_offset);
    EXPECT_LT(glm::distance(beside.intent().probe, plain.intent().probe + offset), 1e-12);
    // In the data, the plane is that of three of its places.
    const Vec3 foot = 0.04 * n, side = glm::normalize(glm::cross(n, Vec3(1.0, 0.0, 0.0)));
    const Vec3 a = place(foot),
               normal =
                   glm::normalize(glm::cross(place(foot + side) - a, place(foot + glm::cross(n, side)) - a));
    EXPECT_NEAR(glm::dot(normal, on_surface.intent().probe - a), 0.0, 1e-12);
    const Vec3 moved = beside.intent().probe - on_surface.intent().probe;
    EXPECT_LT(glm::length(glm::cross(moved, normal)), 1e-12) << "straight down to it";
  }
}

TEST(ImmersiveTechnique, PointsFromItsTipAlongTheStylus) {
  WorkbenchGeometry file = workbench(1.0);
  file.tracker.reset();
  ImmersiveTechnique technique(file, Vec3{0.0}, 0.25);
  const Quat turn = rotation_by({0.4, -0.2, 0.9});
  ASSERT_TRUE(technique.take(stylus({0.1, 0.2, 0.3}, turn), {}));
  const auto& pointing = technique.intent().pointing;
  ASSERT_TRUE(pointing.has_value());
  EXPECT_EQ(pointing->origin, technique.intent().probe);
  const Vec3 along = file.interaction.rotation * (turn * Vec3(0.0, 0.0, -1.0));
  EXPECT_LT(glm::distance(pointing->direction, along), 1e-12) << "the tip is at -z of the sensor";
  ASSERT_TRUE(technique.take(TrackedHands{}, {}));
  EXPECT_FALSE(technique.intent().pointing.has_value()) << "it is not seen";
}

// What the mouse does to the view the hands follow: they stay where the data is shown.
TEST(ImmersiveTechnique, IsWhereTheViewShowsTheData) {
  WorkbenchGeometry file = workbench(1.0);
  file.tracker.reset();
  file.stylus.reset();
  const Screen screen{{-0.3, -0.2, 0.1}, {0.3, -0.2, 0.1}, {-0.3, 0.2, 0.1}};
  ImmersiveTechnique technique(file, Vec3{0.0}, 0.25);
  HandsView seen = view();
  turn(seen.camera, 0.7, -0.3);
  seen.place = place_of(seen.camera, screen);
  ASSERT_TRUE(technique.take(stylus(center(screen)), seen));
  EXPECT_LT(glm::distance(technique.intent().probe, seen.camera.focal_point), 1e-12);
  ASSERT_TRUE(technique.take(stylus(screen.upper_left + Vec3(0.3, 0.0, 0.1)), seen));
  const Vec3 above = seen.camera.focal_point + 0.5 * seen.camera.view_height * seen.camera.axes[1] +
                     0.25 * seen.camera.view_height * seen.camera.axes[2];
  EXPECT_LT(glm::distance(technique.intent().probe, above), 1e-12);
}

}  // namespace
}  // namespace palpate
