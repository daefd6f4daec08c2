#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "common/render/frame_block.h"
#include "common/render/gl/context.h"
#include "common/render/glyph/glyph_pass.h"

namespace palpate {
namespace {

constexpr int kWidth = 160, kHeight = 120;
// Single precision: of the depth buffer's value, whose slope at grazing rays is what limits it.
constexpr double kDepthTolerance = 2e-5;
// Corners of triangles may be moved to the nearest place of a grid this many times finer than pixels, and
// with them all rays (GL_SUBPIXEL_BITS).
double subpixels() {
  GLint bits = 0;
  glGetIntegerv(GL_SUBPIXEL_BITS, &bits);
  return std::exp2(bits);
}
// Rays that miss or hit the silhouette by less than this share of the radius are not judged.
constexpr double kGrazing = 2e-3;

// One sample a pixel, so that each ray is known.
class Canvas {
 public:
  Canvas() {
    std::array<GLuint, 2> names{};
    glCreateRenderbuffers(2, names.data());
    color_ = GlRenderbuffer(names[0]);
    depth_ = GlRenderbuffer(names[1]);
    glNamedRenderbufferStorage(names[0], GL_RGBA8, kWidth, kHeight);
    glNamedRenderbufferStorage(names[1], GL_DEPTH_COMPONENT32F, kWidth, kHeight);
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    framebuffer_ = GlFramebuffer(name);
    glNamedFramebufferRenderbuffer(name, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, names[0]);
    glNamedFramebufferRenderbuffer(name, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, names[1]);
  }

  // Depths from the bottom row up; 1 where nothing is.
  std::vector<float> depths(const FrameBlock& block, const SphereInstance& sphere) {
    const GlBuffer uniforms = make_buffer(std::span<const FrameBlock>(&block, 1));
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, uniforms.name());
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, kWidth, kHeight);
    glDepthMask(GL_TRUE);
    glClearDepth(1.0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    pass_.draw(std::span(&sphere, 1), 0.0F, 0.0F);
    std::vector<float> result(std::size_t{kWidth} * kHeight);
    glReadPixels(0, 0, kWidth, kHeight, GL_DEPTH_COMPONENT, GL_FLOAT, result.data());
    return result;
  }

 private:
  GlRenderbuffer color_, depth_;
  GlFramebuffer framebuffer_;
  SpherePass pass_;
};

// What the ray of a pixel meets, in double precision and from the camera's definition (camera.h, eq. 1).
struct Ray {
  Vec3 origin, direction;
};

Ray ray_of(const Camera& camera, double x, double y) {
  const double pixel = camera.view_height / kHeight;
  const Vec3 aside =
      (x - 0.5 * kWidth) * pixel * camera.axes[0] + (y - 0.5 * kHeight) * pixel * camera.axes[1];
  const Vec3 through = camera.focal_point + aside;
  if (camera.projection == Projection::kPerspective)
    return {eye(camera), glm::normalize(through - eye(camera))};
  return {through + distance(camera) * camera.axes[2], -camera.axes[2]};
}

// The point of the sphere that a ray meets first; it must not miss.
Vec3 hit_by(const Ray& ray, const Vec3& center, double radius) {
  const Vec3 to_center = center - ray.origin;
  const double along = glm::dot(to_center, ray.direction);
  const double apart = glm::length(to_center - along * ray.direction);
  return ray.origin + (along - std::sqrt(radius * radius - apart * apart)) * ray.direction;
}

void expect_exact(const Camera& camera, const Vec3& center, double radius) {
  const Box bounds{Vec3(-0.5), Vec3(0.5)};  // its scene frame is the data
  const ViewTransform transform =
      view_transform(camera, scene_frame(bounds), bounds, double{kWidth} / kHeight);
  const FrameBlock block =
      make_frame_block(camera, transform, palette_of(Background::kDark), true, kWidth, kHeight);
  Canvas canvas;
  const auto depths = canvas.depths(block, {.center = Vec3f(center), .radius = static_cast<float>(radius)});
  const auto depth_of = [&](const Vec3& hit) {
    const Vec4 clip = transform.clip_from_scene * Vec4(hit, 1.0);
    return 0.5 + 0.5 * clip.z / clip.w;
  };
  const double subpixel = 1.0 / subpixels();
  int hits = 0, misses = 0;
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const Ray ray = ray_of(camera, column + 0.5, row + 0.5);
      const Vec3 to_center = center - ray.origin;
      const double apart = glm::length(to_center - glm::dot(to_center, ray.direction) * ray.direction);
      const double found = depths[static_cast<std::size_t>(row * kWidth + column)];
      if (std::abs(apart - radius) < kGrazing * radius) continue;
      if (apart > radius) {
        ++misses;
        ASSERT_EQ(found, 1.0) << column << " " << row;
        continue;
      }
      ++hits;
      const double wanted = depth_of(hit_by(ray, center, radius));
      double moved = 0.0;
      for (const double side : {-subpixel, subpixel}) {
        const double beside =
            depth_of(hit_by(ray_of(camera, column + 0.5 + side, row + 0.5), center, radius));
        const double above = depth_of(hit_by(ray_of(camera, column + 0.5, row + 0.5 + side), center, radius));
        moved = std::max({moved, std::abs(beside - wanted), std::abs(above - wanted)});
      }
      ASSERT_NEAR(found, wanted, kDepthTolerance + moved) << column << " " << row;
    }
  }
  EXPECT_GT(hits, 10);
  EXPECT_GT(misses, 10);
}

class SphereRays : public ::testing::TestWithParam<Projection> {
 protected:
  OffscreenContext context_;
  Camera camera_ = make_camera({Vec3(-0.5), Vec3(0.5)}, {.azimuth = 30.0, .elevation = 20.0, .roll = 15.0},
                               double{kWidth} / kHeight, GetParam());
};

TEST_P(SphereRays, MeetTheSphereWhereGeometrySaysSo) { expect_exact(camera_, Vec3(0.05, 0.1, -0.1), 0.3); }

// In perspective the silhouette is an ellipse, larger than the sphere.
TEST_P(SphereRays, MeetALargeSphereAtTheBorder) {
  camera_.field_of_view = 1.4;
  expect_exact(camera_, 0.55 * camera_.axes[0] + 0.2 * camera_.axes[1] + 0.2 * camera_.axes[2], 0.25);
}

// A hundredth of the picture, as probes are, in a view a thousand times enlarged: differences of squares
// of the distance would have lost all digits.
TEST_P(SphereRays, MeetASmallSphereInAnEnlargedView) {
  camera_.focal_point = Vec3(0.125, 0.25, -0.375);
  camera_.view_height *= 1e-3;
  expect_exact(camera_, camera_.focal_point, 0.05 * camera_.view_height);
}

INSTANTIATE_TEST_SUITE_P(SpherePass, SphereRays,
                         ::testing::Values(Projection::kPerspective, Projection::kOrthographic));

TEST(SpherePass, EyeInsideOrBeforeASphereSeesNothing) {
  const OffscreenContext context;
  const Box bounds{Vec3(-0.5), Vec3(0.5)};
  const Camera camera = make_camera(bounds, {}, double{kWidth} / kHeight);
  const ViewTransform transform =
      view_transform(camera, scene_frame(bounds), bounds, double{kWidth} / kHeight);
  const FrameBlock block =
      make_frame_block(camera, transform, palette_of(Background::kDark), true, kWidth, kHeight);
  Canvas canvas;
  for (const double beyond : {0.0, 0.2, 1.0}) {
    const Vec3 center = eye(camera) + beyond * camera.axes[2];
    for (const float depth : canvas.depths(block, {.center = Vec3f(center), .radius = 0.3F})) {
      ASSERT_EQ(depth, 1.0F) << beyond;
    }
  }
}

}  // namespace
}  // namespace palpate
