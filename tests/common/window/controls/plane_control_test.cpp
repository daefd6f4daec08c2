// Cutting planes in the window: what a press takes hold of, where they cut, and which place of a volume is
// seen under the mouse.

#include "common/window/controls/plane_control.h"

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/volume_examples.h"
#include "common/haptics/widget/widget_text.h"
#include "common/window/controls/pick_volume.h"

namespace palpate {
namespace {

const Box kBox{Vec3(-1.0), Vec3(1.0)};
constexpr int kWidth = 400, kHeight = 200;
constexpr double kRadius = 0.3;

PlanePoses two_planes() {
  PlanePoses poses;
  poses.count = 2;
  poses.pose[0] = pose_of_plane({0.0, 0.0, 1.0}, 0.5, Vec3{0.0});
  poses.pose[1] = pose_of_plane({1.0, 1.0, 0.0}, 0.2, Vec3{0.0});
  return poses;
}

// A mere half-space among the cuts of a picture.
bool keeps(const CuttingPlane& cut, const Vec3& x) {
  return glm::dot(cut.kept.outward, x) <= cut.kept.offset;
}

TEST(PlaneControl, CutsTheVolumeWhereThePlanesAre) {
  VolumeView view;
  Lens ball;
  ball.shape = make_sphere(Vec3{0.0}, 0.4);
  view.lenses = {ball};
  const PlanePoses poses = two_planes();
  cut_by_planes(view, poses);
  ASSERT_EQ(view.cuts.size(), 2U);
  EXPECT_FALSE(keeps(view.cuts[0], {0.0, 0.0, 0.6}));
  EXPECT_TRUE(keeps(view.cuts[0], {0.0, 0.0, 0.4}));
  EXPECT_FALSE(keeps(view.cuts[1], {0.5, 0.0, 0.0}));
  EXPECT_EQ(view.lenses, std::vector<Lens>{ball}) << "lenses are no planes";

  // Again and moved: no further cut, and what is off stays off. A cut that is no plane of the hand stays.
  view.cuts[0].on = false;
  const CuttingPlane other{.kept = {{0.0, 1.0, 0.0}, 0.9}};
  view.cuts.push_back(other);
  PlanePoses moved = poses;
  moved.pose[0] = pose_of_plane({0.0, 0.0, 1.0}, -0.5, Vec3{0.0});
  cut_by_planes(view, moved, 2);
  ASSERT_EQ(view.cuts.size(), 3U);
  EXPECT_FALSE(keeps(view.cuts[0], {0.0, 0.0, 0.4}) || view.cuts[0].on);
  EXPECT_TRUE(view.cuts[1].on);
  moved.count = 1;
  cut_by_planes(view, moved, 2);
  ASSERT_EQ(view.cuts.size(), 2U);
  EXPECT_EQ(view.cuts[1], other);

  const PlanePoses back = planes_of(view, Vec3{0.0});
  ASSERT_EQ(back.count, 2);
  EXPECT_LT(glm::length(plane_of_pose(back.pose[0]) - Vec4(0.0, 0.0, 1.0, -0.5)), 1e-14);
}

TEST(PlaneControl, APressTakesTheSphereInFrontOrTheRing) {
  const Camera camera = make_camera(kBox, {}, 2.0);
  PlanePoses poses;
  poses.count = 1;
  // Faces the camera half from the side.
  poses.pose[0] = pose_of_plane(camera.axes[2] + camera.axes[0], 0.0, Vec3{0.0});
  const auto press = [&](const Vec3& at) {
    const Vec3 shown = project(camera, at, kWidth, kHeight);
    return hold_of_planes(poses, kRadius, camera, {kWidth, kHeight}, {shown.x, shown.y});
  };
  const auto sphere = press(Vec3{0.0});
  ASSERT_TRUE(sphere);
  EXPECT_NEAR(glm::length(*sphere), kRadius, 1e-12);
  EXPECT_GT(glm::dot(*sphere, camera.axes[2]), 0.0) << "in front";
  const Vec3 beside = 1.3 * kRadius * camera.axes[1];
  const auto ring = press(beside);
  ASSERT_TRUE(ring);
  EXPECT_LT(glm::distance(*ring, beside), 1e-12) << "on the plane";
  EXPECT_FALSE(press(2.0 * kRadius * camera.axes[1]));
}

TEST(PlaneControl, ShowsWhereAPlaneMeetsTheBox) {
  PlanePoses poses;
  poses.count = 1;
  poses.pose[0] = pose_of_plane({1.0, 1.0, 1.0}, 0.0, Vec3{0.0});
  const auto lines = lines_of_planes(poses, kBox, kRadius);
  ASSERT_FALSE(lines.empty());
  // Through the middle along the diagonal: a regular hexagon.
  ASSERT_EQ(lines[0].size(), 7U);
  for (std::size_t i = 0; i + 1 < lines[0].size(); ++i) {
    EXPECT_NEAR(glm::dot(lines[0][i], Vec3(1.0)), 0.0, 1e-12);
    EXPECT_NEAR(glm::distance(lines[0][i], lines[0][i + 1]), std::sqrt(2.0), 1e-12);
  }
}

TEST(PickVolume, FindsCutsAndSurfaces) {
  const DataSet data = volume_example("blob");
  const auto field = make_scalar_field({data}, {kVolumeArray, Association::kPoint, 0}, "blob", 1);
  const Box box = field->bounds();
  const Camera camera = make_camera(box, {}, 2.0);
  VolumeView view;
  const double level = 0.5 * (field->lowest() + field->highest());
  const auto at_middle = [&] {
    const Vec3 shown = project(camera, box.center(), kWidth, kHeight);
    return pick_volume(view, box, field, level, camera, {kWidth, kHeight}, {shown.x, shown.y});
  };
  const auto surface = at_middle();
  ASSERT_TRUE(surface);
  CellHint hint;
  EXPECT_NEAR(field->sample(*surface, hint).value, level, 1e-6 * field->highest());

  // A cut that faces the viewer, and a second one before it: the deeper one is seen.
  for (const double depth : {0.4, 0.1}) {
    PlanePoses poses = planes_of(view, box.center());
    poses.pose[static_cast<std::size_t>(poses.count++)] = pose_of_plane(
        camera.axes[2], glm::dot(camera.axes[2], box.center()) + depth * box.size().x, box.center());
    cut_by_planes(view, poses);
    const auto cut = at_middle();
    ASSERT_TRUE(cut);
    EXPECT_NEAR(glm::dot(camera.axes[2], *cut - box.center()), depth * box.size().x, 1e-9);
  }
  for (CuttingPlane& cut : view.cuts) cut.on = false;
  ASSERT_TRUE(at_middle());
  EXPECT_EQ(*at_middle(), *surface) << "planes that are off hide nothing";
}

}  // namespace
}  // namespace palpate
