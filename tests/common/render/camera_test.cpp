#include "common/render/camera.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace palpate {
namespace {

const Box kBox{Vec3(-1.0, -2.0, 0.5), Vec3(3.0, 1.0, 4.0)};
constexpr double kAspect = 1.5;

Vec3 corner(const Box& box, unsigned i) {
  return {(i & 1U) != 0 ? box.upper.x : box.lower.x, (i & 2U) != 0 ? box.upper.y : box.lower.y,
          (i & 4U) != 0 ? box.upper.z : box.lower.z};
}

// The contract: azimuth 0 looks along +y with x to the right and z up; azimuth 90 has gone
// counter-clockwise (seen from above) to +x and looks along -x; elevation 90 looks down.
TEST(Camera, LooksFromWhereAzimuthAndElevationSay) {
  const Camera front = make_camera(kBox, {.azimuth = 0, .elevation = 0}, kAspect);
  EXPECT_LT(glm::distance(front.axes[0], Vec3(1, 0, 0)), 1e-15);
  EXPECT_LT(glm::distance(front.axes[1], Vec3(0, 0, 1)), 1e-15);
  EXPECT_LT(glm::distance(front.axes[2], Vec3(0, -1, 0)), 1e-15);
  const Camera side = make_camera(kBox, {.azimuth = 90, .elevation = 0}, kAspect);
  EXPECT_LT(glm::distance(side.axes[2], Vec3(1, 0, 0)), 1e-15);
  const Camera top = make_camera(kBox, {.azimuth = 0, .elevation = 90}, kAspect);
  EXPECT_LT(glm::distance(top.axes[2], Vec3(0, 0, 1)), 1e-15);
  EXPECT_LT(glm::distance(top.axes[1], Vec3(0, 1, 0)), 1e-15);
}

TEST(Camera, RollTurnsThePictureCounterClockwise) {
  const Camera straight = make_camera(kBox, {.azimuth = 0, .elevation = 0, .roll = 0}, kAspect);
  const Camera rolled = make_camera(kBox, {.azimuth = 0, .elevation = 0, .roll = 90}, kAspect);
  const Vec3 point = straight.focal_point + Vec3(0.5, 0.0, 0.0);  // right of the middle
  const Vec3 before = project(straight, point, 300, 200), after = project(rolled, point, 300, 200);
  EXPECT_GT(before.x, 151.0);
  EXPECT_NEAR(after.x, 150.0, 1e-9);
  EXPECT_LT(after.y, 99.0);  // now above it
}

TEST(Camera, FitShowsEveryCornerAndWastesLittle) {
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    for (double azimuth = 0.0; azimuth < 360.0; azimuth += 37.0) {
      for (double elevation = -80.0; elevation <= 80.0; elevation += 40.0) {
        for (const double aspect : {0.4, 1.0, 2.5}) {
          const int height = 1000, width = static_cast<int>(1000 * aspect);
          const Camera camera = make_camera(kBox, {azimuth, elevation, 0.0, 1.0}, aspect, projection);
          double reach = 0.0;  // 1 at the border of the picture
          for (unsigned i = 0; i < 8; ++i) {
            const Vec3 p = project(camera, corner(kBox, i), width, height);
            EXPECT_GT(p.z, 0.0);
            reach = std::max({reach, std::abs(p.x - 0.5 * width) / (0.5 * width),
                              std::abs(p.y - 0.5 * height) / (0.5 * height)});
          }
          EXPECT_LT(reach, 1.0);
          EXPECT_GT(reach, 0.75);
        }
      }
    }
  }
}

TEST(Camera, DegenerateBoxesGiveAUsableView) {
  const Box cases[] = {Box{},
                       Box{Vec3(5.0), Vec3(5.0)},
                       Box{Vec3(0.0), Vec3(0.0)},
                       Box{Vec3(-1.0, -1.0, 0.0), Vec3(1.0, 1.0, 0.0)},
                       Box{Vec3(NAN), Vec3(NAN)},
                       Box{Vec3(-1e300), Vec3(1e300)},
                       Box{Vec3(1e-300), Vec3(3e-300)}};
  for (const Box& box : cases) {
    const Camera camera = make_camera(box, {}, kAspect);
    EXPECT_TRUE(is_finite(camera.focal_point));
    EXPECT_GT(camera.view_height, 0.0);
    EXPECT_TRUE(std::isfinite(camera.view_height));
    const ViewTransform view = view_transform(camera, scene_frame(box), box, kAspect);
    for (int c = 0; c < 4; ++c) {
      for (int r = 0; r < 4; ++r) EXPECT_TRUE(std::isfinite(view.clip_from_scene[c][r]));
    }
  }
}

TEST(Camera, TurningKeepsTheFocalPointAndTheDistance) {
  Camera camera = make_camera(kBox, {}, kAspect);
  const Camera before = camera;
  turn(camera, 0.7, -0.3);
  EXPECT_EQ(camera.focal_point, before.focal_point);
  EXPECT_EQ(distance(camera), distance(before));
  EXPECT_GT(glm::distance(eye(camera), eye(before)), 0.1 * distance(before));
}

// What lies before the focal point follows the mouse.
TEST(Camera, TurningMovesTheNearSideWithTheMouse) {
  Camera camera = make_camera(kBox, {}, kAspect);
  const Vec3 near_side = camera.focal_point + 0.2 * camera.view_height * camera.axes[2];
  const Vec3 before = project(camera, near_side, 300, 200);
  turn(camera, 0.1, 0.0);
  const Vec3 right = project(camera, near_side, 300, 200);
  EXPECT_GT(right.x, before.x + 1.0);
  EXPECT_NEAR(right.y, before.y, 1e-9);
  turn(camera, -0.1, 0.1);
  EXPECT_LT(project(camera, near_side, 300, 200).y, before.y - 1.0);
}

TEST(Camera, AxesStayOrthonormalThroughTenThousandTurns) {
  Camera camera = make_camera(kBox, {}, kAspect);
  std::mt19937 random{5};
  std::uniform_real_distribution<double> angle{-0.2, 0.2};
  for (int i = 0; i < 10'000; ++i) {
    turn(camera, angle(random), angle(random));
    roll(camera, angle(random));
  }
  const Mat3 product = glm::transpose(camera.axes) * camera.axes;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) EXPECT_NEAR(product[c][r], c == r ? 1.0 : 0.0, 1e-14);
  }
  EXPECT_NEAR(glm::determinant(camera.axes), 1.0, 1e-14);
}

TEST(Camera, ZoomKeepsThePointUnderTheCursor) {
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    Camera camera = make_camera(kBox, {}, kAspect, projection);
    const double to_right = 0.31, to_top = -0.17;
    // The point of the focal plane that is shown there.
    const Vec3 point =
        camera.focal_point + camera.view_height * (to_right * camera.axes[0] + to_top * camera.axes[1]);
    const Vec3 before = project(camera, point, 300, 200);
    zoom(camera, 3.0, to_right, to_top);
    const Vec3 after = project(camera, point, 300, 200);
    EXPECT_NEAR(before.x, 150.0 + 200.0 * to_right, 1e-9);
    EXPECT_NEAR(after.x, before.x, 1e-9);
    EXPECT_NEAR(after.y, before.y, 1e-9);
  }
}

TEST(Camera, PanMovesTheFocalPlaneByWholeHeights) {
  Camera camera = make_camera(kBox, {}, kAspect);
  const Vec3 point = camera.focal_point;
  pan(camera, 0.25, -0.5);
  const Vec3 p = project(camera, point, 300, 200);
  EXPECT_NEAR(p.x, 150.0 + 50.0, 1e-9);
  EXPECT_NEAR(p.y, 100.0 + 100.0, 1e-9);
}

TEST(Camera, BothProjectionsShowTheFocalPlaneAtOneSize) {
  Camera camera = make_camera(kBox, {}, kAspect, Projection::kPerspective);
  const Vec3 point = camera.focal_point + 0.3 * camera.view_height * camera.axes[0];
  const Vec3 perspective = project(camera, point, 300, 200);
  camera.projection = Projection::kOrthographic;
  const Vec3 orthographic = project(camera, point, 300, 200);
  EXPECT_NEAR(perspective.x, orthographic.x, 1e-9);
  EXPECT_NEAR(perspective.y, orthographic.y, 1e-9);
}

// project() and the matrix for the GPU are written apart: they must agree on every point.
TEST(ViewTransform, AgreesWithTheProjectionOfPoints) {
  constexpr int kWidth = 300, kHeight = 200;
  std::mt19937 random{3};
  std::uniform_real_distribution<double> part{0.0, 1.0};
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    const Camera camera = make_camera(kBox, {25.0, -40.0, 12.0, 1.7}, 1.5, projection);
    const SceneFrame frame = scene_frame(kBox);
    const ViewTransform view = view_transform(camera, frame, kBox, 1.5);
    for (int i = 0; i < 100; ++i) {
      const Vec3 x = kBox.lower + Vec3(part(random), part(random), part(random)) * kBox.size();
      const Vec4 clip = view.clip_from_scene * Vec4(frame.scene_from_data(x), 1.0);
      const Vec3 pixel = project(camera, x, kWidth, kHeight);
      EXPECT_NEAR((0.5 + 0.5 * clip.x / clip.w) * kWidth, pixel.x, 1e-9);
      EXPECT_NEAR((0.5 - 0.5 * clip.y / clip.w) * kHeight, pixel.y, 1e-9);
      EXPECT_GE(clip.z / clip.w, -1.0);
      EXPECT_LE(clip.z / clip.w, 1.0);
    }
  }
}

TEST(SceneFrame, CoordinatesAreNearOneWhateverTheUnits) {
  for (const double scale : {1e-30, 1.0, 3e7, 1e30}) {
    const Box box{kBox.lower * scale, kBox.upper * scale};
    const SceneFrame frame = scene_frame(box);
    const Vec3 upper = frame.scene_from_data(box.upper);
    EXPECT_GE(upper.x, 0.5 - 1e-12);
    EXPECT_LT(upper.x, 1.0 + 1e-12);
    EXPECT_LT(glm::length(frame.scene_from_data(box.center())), 1e-12);
  }
}

TEST(ViewTransform, ScalingByAPowerOfTwoGivesTheSameBits) {
  const double scale = std::ldexp(1.0, 60);
  const Box large{kBox.lower * scale, kBox.upper * scale};
  Camera a = make_camera(kBox, {}, kAspect), b = make_camera(large, {}, kAspect);
  for (Camera* camera : {&a, &b}) {
    turn(*camera, 0.3, 0.2);
    pan(*camera, 0.1, 0.05);
    zoom(*camera, 1.3, 0.2, -0.1);
  }
  EXPECT_EQ(a.view_height * scale, b.view_height);
  const ViewTransform va = view_transform(a, scene_frame(kBox), kBox, kAspect);
  const ViewTransform vb = view_transform(b, scene_frame(large), large, kAspect);
  EXPECT_EQ(va.clip_from_scene, vb.clip_from_scene);
  EXPECT_EQ(va.near_depth, vb.near_depth);
}

}  // namespace
}  // namespace palpate
