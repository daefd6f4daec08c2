// A mouse leads a probe along a surface: around a sphere, which bends away from the plane of the view.

#include <gtest/gtest.h>

#include "common/field/analytic/volume_examples.h"
#include "common/hand/technique/probe_mouse.h"
#include "tests/common/trace/sampled_scalars.h"

namespace palpate {
namespace {

constexpr PictureSize kSize{600, 400};

class SurfaceDrag : public ::testing::TestWithParam<Projection> {
 protected:
  /// To `degrees` round from where the sphere is nearest to the viewer, seen along -y; in steps of pixels,
  /// with the proxy on the sphere behind the probe, as the layer's is.
  Vec3 around(double degrees, double pressed) {
    const Camera camera = camera_along_y();
    const Vec3 sight = -camera.axes[2];
    Vec3 probe = Vec3{0.0, -1.0, 0.0} + pressed * sight;
    const double end = std::sin(degrees * 3.14159265358979 / 180.0);
    for (int n = 0; n < 1000 && probe.x < end; ++n) {
      const Vec3 proxy = glm::normalize(probe);
      const Vec3 from = at_depth_of(camera, probe, proxy);
      const Vec3 to = dragged(camera, kSize, from, 2.0, 0.0, std::nullopt);
      const auto moved = dragged_along({*field_, 1.0, proxy}, camera, probe, to);
      if (!moved) return Vec3{0.0};
      probe = *moved;
      farthest_ = std::max(farthest_, std::abs(glm::length(probe) - 1.0));
    }
    return probe;
  }
  Camera camera_along_y() const {
    Camera camera = make_camera({Vec3{-1.5}, Vec3{1.5}}, {}, 1.5, GetParam());
    camera.axes = Mat3{{1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, -1.0, 0.0}};
    return camera;
  }

  std::shared_ptr<const ScalarField> field_ = test::on_uniform(sphere_scalar(), Index3{61});
  double farthest_ = 0.0;  ///< from the sphere
};

TEST_P(SurfaceDrag, StaysOnAWallThatBendsAway) {
  const Vec3 end = around(65.0, 0.0);
  EXPECT_GT(end.x, 0.9);
  EXPECT_LT(end.y, -0.1) << "on the side that is seen";
  EXPECT_LT(farthest_, 2e-3) << "the grid's own error";
}

TEST_P(SurfaceDrag, KeepsHowFarTheWheelHasPushed) {
  const Vec3 end = around(40.0, 0.05);
  const Camera camera = camera_along_y();
  const Vec3 sight =
      GetParam() == Projection::kOrthographic ? -camera.axes[2] : glm::normalize(end - eye(camera));
  EXPECT_NEAR(glm::length(end - 0.05 * sight), 1.0, 3e-3);
}

TEST_P(SurfaceDrag, IsFreeBeyondTheContourAndOffTheSurface) {
  const Camera camera = camera_along_y();
  const Vec3 rim{0.999, -0.045, 0.0};
  EXPECT_FALSE(dragged_along({*field_, 1.0, rim}, camera, rim, Vec3{1.2, -0.045, 0.0}));
  EXPECT_FALSE(dragged_along({*field_, 1.0, Vec3{0.0, -1.0, 0.0}}, camera, Vec3{9.0}, Vec3{9.1}));
  // The other side of the sphere, which is under the mouse too, is another wall.
  const auto front =
      dragged_along({*field_, 1.0, Vec3{0.0, -1.0, 0.0}}, camera, Vec3{0.0, -1.0, 0.0}, Vec3{0.3, -1.0, 0.0});
  ASSERT_TRUE(front);
  EXPECT_LT(front->y, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Both, SurfaceDrag,
                         ::testing::Values(Projection::kPerspective, Projection::kOrthographic));

}  // namespace
}  // namespace palpate
