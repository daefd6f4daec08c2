#include "common/render/stereo/stereo_view.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace palpate {
namespace {

const Box kBox{Vec3(-1.0, -2.0, 0.5), Vec3(3.0, 1.0, 4.0)};

// Where clip_from_scene puts a point, in [-1, 1].
Vec3 shown_at(const ViewTransform& view, const SceneFrame& frame, const Vec3& x) {
  const Vec4 clip = view.clip_from_scene * Vec4(frame.scene_from_data(x), 1.0);
  return Vec3(clip) / clip.w;
}

// The corners of the rectangle on the focal plane are the corners of the picture, wherever the eye is: that
// is what makes it a window into the scene.
TEST(OffAxisCamera, CornersOfTheScreenAreThoseOfThePictureForAnyEye) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  const SceneFrame frame = scene_frame(kBox);
  constexpr double kAspect = 1.6;
  constexpr int kEyes = 1000, kHeight = 1000;
  double worst = 0.0;
  for (int i = 0; i < kEyes; ++i) {
    Camera camera = make_camera(kBox, {180.0 * anywhere(random), 89.0 * anywhere(random)}, kAspect);
    const double h = camera.view_height;
    camera.field_of_view = 2.0 * std::atan(0.5 / (0.3 + 3.0 * std::abs(anywhere(random))));
    camera.eye_offset = {3.0 * h * anywhere(random), 3.0 * h * anywhere(random)};
    const ViewTransform view = view_transform(camera, frame, kBox, kAspect);
    for (const double x : {-1.0, 0.0, 1.0}) {
      for (const double y : {-1.0, 0.0, 1.0}) {
        const Vec3 corner =
            camera.focal_point + 0.5 * h * (kAspect * x * camera.axes[0] + y * camera.axes[1]);
        const Vec3 shown = shown_at(view, frame, corner);
        worst = std::max({worst, std::abs(shown.x - x), std::abs(shown.y - y)});
        const Vec3 pixel = project(camera, corner, static_cast<int>(kAspect * kHeight), kHeight);
        EXPECT_NEAR(pixel.x, 0.5 * kAspect * kHeight * (1.0 + x), 1e-8);
        EXPECT_NEAR(pixel.y, 0.5 * kHeight * (1.0 - y), 1e-8);
      }
    }
  }
  EXPECT_LT(worst, 1e-13);
}

// A screen anywhere in space, corners to corners, however the head is held before it.
TEST(ScreenCamera, CornersOfTheScreenAreThoseOfThePictureForAnyHead) {
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  constexpr int kHeads = 1000;
  double worst = 0.0;
  for (int i = 0; i < kHeads; ++i) {
    const auto vector = [&] { return Vec3(anywhere(random), anywhere(random), anywhere(random)); };
    const Vec3 right = glm::normalize(vector()), up = glm::normalize(glm::cross(right, vector()));
    const Vec3 corner = vector();
    const double w = 0.2 + std::abs(anywhere(random)), h = 0.2 + std::abs(anywhere(random));
    const Screen screen{corner, corner + w * right, corner + h * up};
    ASSERT_EQ(fault_of(screen), "");
    const Vec3 head = center(screen) + anywhere(random) * right + anywhere(random) * up +
                      (0.2 + std::abs(anywhere(random))) * glm::cross(right, up);
    const Camera camera = seen_from(screen_camera(screen), head);
    EXPECT_LT(glm::distance(eye(camera), head), 1e-14);
    const SceneFrame frame = scene_frame(kBox);
    const ViewTransform view = view_transform(camera, frame, kBox, w / h);
    const auto error = [&](const Vec3& x, double to_right, double to_top) {
      const Vec3 shown = shown_at(view, frame, x);
      worst = std::max({worst, std::abs(shown.x - to_right), std::abs(shown.y - to_top)});
    };
    error(screen.lower_left, -1.0, -1.0);
    error(screen.lower_right, 1.0, -1.0);
    error(screen.upper_left, -1.0, 1.0);
    error(screen.upper_left + screen.lower_right - screen.lower_left, 1.0, 1.0);
  }
  EXPECT_LT(worst, 2e-13);
}

TEST(ScreenCamera, RefusesCornersThatAreNoRectangles) {
  EXPECT_NE(fault_of({{0, 0, 0}, {1, 0, 0}, {0.1, 1, 0}}), "");
  EXPECT_NE(fault_of({{0, 0, 0}, {0, 0, 0}, {0, 1, 0}}), "");
  EXPECT_EQ(fault_of({{0, 0, 0}, {1, 0, 0}, {0.001, 1, 0}}), "");
}

// Independent of the projection's formula: the line from the eye through a point, cut with the focal plane.
TEST(OffAxisCamera, ShowsAPointWhereTheLineFromTheEyeMeetsTheScreen) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  const SceneFrame frame = scene_frame(kBox);
  constexpr double kAspect = 0.7;
  for (int i = 0; i < 200; ++i) {
    Camera camera = make_camera(kBox, {180.0 * anywhere(random), 80.0 * anywhere(random)}, kAspect);
    camera.eye_offset = {anywhere(random), anywhere(random)};
    const Vec3 x =
        kBox.center() + 0.5 * kBox.size() * Vec3(anywhere(random), anywhere(random), anywhere(random));
    const Vec3 from = eye(camera), along = x - from;
    const double t = glm::dot(camera.focal_point - from, camera.axes[2]) / glm::dot(along, camera.axes[2]);
    const Vec3 there = from + t * along - camera.focal_point;
    const Vec3 shown = shown_at(view_transform(camera, frame, kBox, kAspect), frame, x);
    EXPECT_NEAR(shown.x, 2.0 * glm::dot(there, camera.axes[0]) / (kAspect * camera.view_height), 1e-12);
    EXPECT_NEAR(shown.y, 2.0 * glm::dot(there, camera.axes[1]) / camera.view_height, 1e-12);
  }
}

// Eyes may be as far apart as the limit says: there the disparity is reached, by (1), which the root does not
// use.
TEST(Stereo, SeparationOfADisparityGivesThatDisparity) {
  for (const double d : {0.3, 1.0, 7.0}) {
    for (const double ratio : {0.2, 0.6, 0.99, 1.01, 3.0, 40.0}) {
      for (const double eta : {1e-4, 0.0175, 0.05}) {
        const double e = separation_of_disparity(eta, ratio * d, d);
        if (!std::isfinite(e)) continue;
        EXPECT_NEAR(std::abs(angular_disparity(e, ratio * d, d)), eta, 1e-12 * (1.0 + eta));
        EXPECT_LT(std::abs(angular_disparity(0.99 * e, ratio * d, d)), eta);
      }
    }
  }
  EXPECT_TRUE(std::isinf(separation_of_disparity(0.01, 2.0, 2.0)));  // on the screen
  // Points hardly before the screen never reach it, however far apart the eyes are.
  EXPECT_TRUE(std::isinf(separation_of_disparity(0.05, 0.99, 1.0)));
}

TEST(Stereo, EyesKeepWhatCanBeFusedAndNoMoreIsTakenThanNeeded) {
  for (const double zoom : {0.3, 1.0, 2.0, 8.0}) {
    const Camera camera = make_camera(kBox, {.zoom = zoom}, 1.5);
    const StereoView wanted{.mode = StereoMode::kAnaglyph, .separation = 0.2};
    const StereoEyes eyes = stereo_eyes(camera, wanted, kBox);
    const double worst = std::max(std::abs(eyes.near_disparity), std::abs(eyes.far_disparity));
    EXPECT_LE(worst, wanted.most_disparity * (1.0 + 1e-9));
    EXPECT_GE(eyes.near_disparity, 0.0);
    EXPECT_LE(eyes.far_disparity, 0.0);
    EXPECT_NEAR(eyes.separation, eyes.limited * wanted.separation, 1e-15);
    if (eyes.limited < 1.0) {
      EXPECT_NEAR(worst, wanted.most_disparity, 1e-9);
    }
    EXPECT_NEAR(glm::distance(eye(eyes.cameras[0]), eye(eyes.cameras[1])), eyes.separation * distance(camera),
                1e-12);
    // The left eye is on the left, and neither turns: they share the screen.
    EXPECT_LT(eyes.cameras[0].eye_offset.x, 0.0);
    EXPECT_EQ(eyes.cameras[0].axes, camera.axes);
  }
  const Camera camera = make_camera(kBox, {}, 1.5);
  const StereoView narrow{.mode = StereoMode::kRows, .separation = 1e-3};
  EXPECT_DOUBLE_EQ(stereo_eyes(camera, narrow, kBox).separation, 1e-3);
}

TEST(Stereo, TrackedEyesAreWhereTheHeadHasThemUnlessThatCannotBeFused) {
  const Camera camera = make_camera(kBox, {}, 1.5);
  const double d = distance(camera);
  const Vec3 middle =
      eye(camera) + 0.2 * d * camera.axes[0] - 0.1 * d * camera.axes[1] + 0.3 * d * camera.axes[2];
  const Vec3 half = 1e-3 * d * glm::normalize(camera.axes[0] + 0.3 * camera.axes[1]);  // a tilted head
  StereoView stereo{.mode = StereoMode::kRows};
  stereo.eyes = {middle - half, middle + half};
  const StereoEyes eyes = stereo_eyes(camera, stereo, kBox);
  EXPECT_LT(glm::distance(eye(eyes.cameras[0]), middle - half), 1e-13 * d);
  EXPECT_LT(glm::distance(eye(eyes.cameras[1]), middle + half), 1e-13 * d);
  EXPECT_EQ(eyes.limited, 1.0);
  stereo.eyes = {middle - 300.0 * half, middle + 300.0 * half};
  const StereoEyes nearer = stereo_eyes(camera, stereo, kBox);
  EXPECT_LT(nearer.limited, 1.0);
  EXPECT_NEAR(std::max(nearer.near_disparity, -nearer.far_disparity), stereo.most_disparity, 1e-12);
  EXPECT_LT(glm::distance(0.5 * (eye(nearer.cameras[0]) + eye(nearer.cameras[1])), middle), 1e-12 * d);
}

TEST(Stereo, EyesGetTheirShareOfThePicture) {
  EXPECT_EQ(eye_picture_size(StereoMode::kSideBySide, 801, 600).width, 400);
  EXPECT_EQ(eye_picture_size(StereoMode::kTopBottom, 800, 601).height, 300);
  EXPECT_EQ(eye_picture_size(StereoMode::kRows, 800, 600).height, 600);
  EXPECT_THROW((void)eye_picture_size(StereoMode::kSideBySide, 1, 600), Error);
}

}  // namespace
}  // namespace palpate
