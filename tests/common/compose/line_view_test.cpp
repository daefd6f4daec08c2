#include "common/compose/line_view.h"

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/compose/domain_outline.h"
#include "common/field/analytic/examples.h"
#include "tests/support/sampled.h"

namespace palpate::test {
namespace {

const Box kBox{Vec3(-1.0, 0.0, 2.0), Vec3(3.0, 1.0, 4.0)};

TEST(CameraAngles, AreReadAndRefused) {
  const CameraAngles angles = camera_angles("10,-20,30,2");
  EXPECT_EQ(angles.azimuth, 10.0);
  EXPECT_EQ(angles.elevation, -20.0);
  EXPECT_EQ(angles.roll, 30.0);
  EXPECT_EQ(angles.zoom, 2.0);
  EXPECT_EQ(camera_angles("").zoom, CameraAngles{}.zoom);
  for (const char* text : {"1,2,3", "1,2,3,0", "1,2,3,-1", "a,b,c,d", "1,2,3,4,5"}) {
    EXPECT_THROW((void)camera_angles(text), Error) << text;
  }
}

// camera_text() undoes make_camera(): what a session saves is the view that was on the screen.
TEST(CameraText, IsTheInverseOfMakeCamera) {
  constexpr double kAspect = 1.5;
  for (const char* text : {"30,20,0,1", "-120,-45,10,2.5", "179,80,-60,0.5", "0,0,0,1", "90,0,170,1"}) {
    const Camera camera = make_camera(kBox, camera_angles(text), kAspect);
    const std::string saved = camera_text(camera, kBox, kAspect);
    const Camera again = make_camera(kBox, camera_angles(saved), kAspect);
    for (int axis = 0; axis < 3; ++axis) {
      // Angles are written to a thousandth of a degree.
      EXPECT_LT(glm::distance(camera.axes[axis], again.axes[axis]), 5e-5) << text << " -> " << saved;
    }
    EXPECT_NEAR(again.view_height / camera.view_height, 1.0, 1e-5) << text << " -> " << saved;
  }
}

TEST(CameraOf, LooksAtTheFocalPointAndElseAtTheMiddle) {
  ViewOptions options{.camera = "30,20,0,2"};
  const Camera whole = camera_of(options, kBox, 1.5);
  EXPECT_EQ(whole, make_camera(kBox, camera_angles("30,20,0,2"), 1.5));
  options.focal = "0.5,-1,1e-3";
  Camera moved = camera_of(options, kBox, 1.5);
  EXPECT_EQ(moved.focal_point, Vec3(0.5, -1.0, 1e-3));
  moved.focal_point = whole.focal_point;
  EXPECT_EQ(moved, whole);
  for (const char* text : {"1,2", "1,2,3,4", "a,b,c", "nan,0,0", "1,2,inf"}) {
    options.focal = text;
    EXPECT_THROW((void)camera_of(options, kBox, 1.5), Error) << text;
  }
}

// A block with flat sides and 4 x 4 x 4 cells: its outline is the twelve edges of the box, four pieces each,
// and none of the diagonals of the tetrahedra on its sides.
TEST(DomainOutline, IsTheSharpEdgesOfATetrahedralDomain) {
  const auto cube = sample_mapped(*example("cavity"), {5, 5, 5}, [](const Vec3& u) { return u; });
  const auto field =
      make_vector_field({cube}, VectorChoice{.arrays = {kSampledName}, .label = "velocity"}, "cube");
  const auto outline = domain_outline(*field);
  EXPECT_EQ(outline.size(), 12U * 4U);
  for (const auto& edge : outline) {
    const Vec3 along = edge[1] - edge[0];
    EXPECT_NEAR(glm::length(along), 0.25, 1e-6);
    EXPECT_NEAR(std::abs(along.x) + std::abs(along.y) + std::abs(along.z), 0.25, 1e-6);
  }
}

TEST(DomainOutline, IsLeftToTheBoundsWhereTheyAreTheDomain) {
  EXPECT_TRUE(domain_outline(*make_vector_field(example("abc"))).empty());
}

}  // namespace
}  // namespace palpate::test
