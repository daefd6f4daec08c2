#include "common/hand/technique/probe_mouse.h"

#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace palpate {
namespace {

const PictureSize kSize{640, 400};

/// From all sides, in both projections.
std::vector<Camera> cameras(double unit = 1.0) {
  std::vector<Camera> result;
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    for (const CameraAngles& angles :
         {CameraAngles{}, CameraAngles{-70.0, 60.0, 15.0, 3.0}, CameraAngles{200.0, -35.0}}) {
      result.push_back(make_camera({Vec3{-unit}, Vec3{2.0 * unit}}, angles, 1.6, projection));
    }
  }
  return result;
}

PicturePoint shown(const Camera& camera, const Vec3& x) {
  const Vec3 at = project(camera, x, kSize.width, kSize.height);
  return {at.x, at.y};
}

TEST(ProbeMouse, WhatIsDraggedStaysUnderTheMouse) {
  for (const Camera& camera : cameras()) {
    for (const Vec3& from : {Vec3{0.5}, Vec3{-0.9, 1.5, 0.3}, Vec3{1.9, -0.5, 1.7}}) {
      const PicturePoint before = shown(camera, from);
      const Vec3 to = dragged(camera, kSize, from, 31.0, -47.0, std::nullopt);
      EXPECT_NEAR(shown(camera, to).x, before.x + 31.0, 1e-9);
      EXPECT_NEAR(shown(camera, to).y, before.y - 47.0, 1e-9);
      EXPECT_NEAR(glm::dot(to - from, camera.axes[2]), 0.0, 1e-12) << "in the plane of the view";
    }
  }
}

TEST(ProbeMouse, AnotherDepthKeepsThePlaceInThePicture) {
  for (const Camera& camera : cameras()) {
    const Vec3 x{0.2, 0.6, 0.9}, line{1.4, -0.3, 0.1};
    const Vec3 moved = at_depth_of(camera, x, line);
    EXPECT_NEAR(shown(camera, moved).x, shown(camera, x).x, 1e-9);
    EXPECT_NEAR(shown(camera, moved).y, shown(camera, x).y, 1e-9);
    EXPECT_NEAR(project(camera, moved, 640, 400).z, project(camera, line, 640, 400).z, 1e-12);
    const Vec3 behind = eye(camera) + camera.axes[2];
    if (camera.projection == Projection::kPerspective) {
      EXPECT_EQ(at_depth_of(camera, x, behind), x);
    }
  }
}

TEST(ProbeMouse, TheWheelMovesAlongTheView) {
  for (const Camera& camera : cameras()) {
    const Vec3 from{0.2, 0.6, 0.9};
    const Vec3 to = pushed(camera, from, 3.0, std::nullopt);
    EXPECT_LE(glm::distance(to - from, -0.06 * camera.view_height * camera.axes[2]), 1e-12);
    EXPECT_GT(project(camera, to, 640, 400).z, project(camera, from, 640, 400).z) << "away from the viewer";
    EXPECT_LE(glm::distance(pushed(camera, to, -3.0, std::nullopt), from), 1e-12);
  }
}

TEST(ProbeMouse, ALockedAxisTakesTheNearestStepThatItHas) {
  for (const Camera& camera : cameras()) {
    if (camera.projection != Projection::kOrthographic) continue;  // the nearest is exact without perspective
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 from{0.4, 0.1, -0.2};
      const Vec3 to = dragged(camera, kSize, from, 20.0, 35.0, axis);
      for (int other = 0; other < 3; ++other) {
        if (other != axis) {
          EXPECT_EQ(to[other], from[other]);
        }
      }
      const auto miss = [&](double shift) {
        Vec3 x = to;
        x[axis] += shift;
        const PicturePoint at = shown(camera, x), start = shown(camera, from);
        return std::hypot(at.x - start.x - 20.0, at.y - start.y - 35.0);
      };
      EXPECT_LT(miss(0.0), miss(1e-3));
      EXPECT_LT(miss(0.0), miss(-1e-3));
    }
  }
}

TEST(ProbeMouse, TheWheelGoesAlongALockedAxisAwayFromTheViewer) {
  for (const Camera& camera : cameras()) {
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = pushed(camera, Vec3{0.5}, 1.0, axis) - Vec3{0.5};
      EXPECT_NEAR(std::abs(step[axis]), 0.02 * camera.view_height, 1e-12);
      EXPECT_NEAR(glm::length(step), std::abs(step[axis]), 1e-15);
      EXPECT_LE(glm::dot(step, camera.axes[2]), 0.0);
    }
  }
}

TEST(ProbeMouse, AnAxisSeenEndOnDoesNotThrowTheProbeAway) {
  Camera camera = make_camera({Vec3{-1.0}, Vec3{1.0}}, {0.0, 0.0}, 1.6);  // along +y
  for (const double tilt : {0.0, 1e-9, 1e-3}) {
    Camera tilted = camera;
    turn(tilted, tilt, 0.0);
    const Vec3 to = dragged(tilted, kSize, Vec3{0.0}, 100.0, 100.0, 1);
    EXPECT_LE(std::abs(to.y), 20.0 * camera.view_height * 100.0 / kSize.height) << tilt;
    EXPECT_EQ(to.x, 0.0);
  }
  EXPECT_EQ(dragged(camera, kSize, Vec3{0.0}, 0.0, 0.0, 1), Vec3(0.0));
}

TEST(ProbeMouse, APointIsFoundUnderTheMouseAtTheDepthOfAnother) {
  for (const Camera& camera : cameras()) {
    const Vec3 depth_of{0.3, -0.4, 0.8};
    const PicturePoint mouse{112.0, 301.0};
    const Vec3 x = under_mouse(camera, kSize, mouse, depth_of);
    EXPECT_NEAR(shown(camera, x).x, mouse.x, 1e-9);
    EXPECT_NEAR(shown(camera, x).y, mouse.y, 1e-9);
    EXPECT_NEAR(glm::dot(x - depth_of, camera.axes[2]), 0.0, 1e-12);
  }
}

TEST(ProbeMouse, AProbeBehindTheEyeStillMovesAsTheMouseDoes) {
  const Camera camera = make_camera({Vec3{-1.0}, Vec3{1.0}}, {}, 1.6);
  const Vec3 behind = eye(camera) + 3.0 * camera.axes[2];
  const Vec3 step = dragged(camera, kSize, behind, 10.0, 0.0, std::nullopt) - behind;
  EXPECT_GT(glm::dot(step, camera.axes[0]), 0.0);
  EXPECT_TRUE(is_finite(step));
}

TEST(ProbeMouse, ScaledByAPowerOfTwoIsTheSameInTheLastBit) {
  constexpr double kUnit = 0x1p-30;
  const std::vector<Camera> ones = cameras(), scaled = cameras(kUnit);
  for (std::size_t i = 0; i < ones.size(); ++i) {
    const Vec3 x{0.1, 0.7, -0.3};
    for (const std::optional<int> axis : {std::optional<int>{}, std::optional{0}, std::optional{2}}) {
      EXPECT_EQ(dragged(scaled[i], kSize, kUnit * x, 7.0, -3.0, axis),
                kUnit * dragged(ones[i], kSize, x, 7.0, -3.0, axis));
      EXPECT_EQ(pushed(scaled[i], kUnit * x, 2.0, axis), kUnit * pushed(ones[i], x, 2.0, axis));
    }
  }
}

}  // namespace
}  // namespace palpate
