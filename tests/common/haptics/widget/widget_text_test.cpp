// Frames, landmarks and poses as words: they come back to the bit, and nonsense is refused with its reason.

#include "common/haptics/widget/widget_text.h"

#include <string>

#include <gtest/gtest.h>

#include "common/haptics/widget/plane_widget.h"

namespace palpate {
namespace {

TEST(WidgetText, ComesBackToTheBit) {
  for (const char* text : {"data", "world", "plane:0.1,0.2,-0.3,12.75", "axes:1,0.1,0,0,1,1e-3"}) {
    GridFrame frame, again;
    EXPECT_FALSE(read_text(text, frame)) << text;
    EXPECT_FALSE(read_text(text_of(frame), again));
    EXPECT_EQ(frame, again);
  }
  GridMarks marks, marks_again;
  EXPECT_FALSE(read_text("x:12.5/z:0.1/plane:1,1,0,45", marks));
  ASSERT_EQ(marks.count, 3);
  EXPECT_EQ(marks.mark[1].axis, 2);
  EXPECT_EQ(marks.mark[2].normal, Vec3(1.0, 1.0, 0.0));
  EXPECT_FALSE(read_text(text_of(marks), marks_again));
  EXPECT_EQ(marks, marks_again);
  PlanePoses poses, poses_again;
  EXPECT_FALSE(read_text("0.3,-0.2,1,17.3/1,2,3,0,0,0,1", poses));
  ASSERT_EQ(poses.count, 2);
  EXPECT_FALSE(read_text(text_of(poses), poses_again));
  EXPECT_EQ(poses, poses_again);
}

TEST(WidgetText, APlaneIsItsPose) {
  const Vec3 n{0.3, -0.2, -1.0};
  const PlanePose pose = pose_of_plane(n, 17.3, {5.0, 6.0, 7.0});
  EXPECT_NEAR(glm::dot(n, pose.center), 17.3, 1e-13);
  EXPECT_LT(glm::length(glm::cross(n, pose.center - Vec3(5.0, 6.0, 7.0))), 1e-12) << "the nearest point";
  EXPECT_LT(glm::distance(axes_of(pose)[2], glm::normalize(n)), 4e-15);
  const Vec4 plane = plane_of_pose(pose);
  EXPECT_NEAR(plane.w, 17.3 / glm::length(n), 1e-13);
  // Straight down is half a turn from where a pose begins.
  EXPECT_LT(glm::distance(axes_of(pose_of_plane({0.0, 0.0, -2.0}, 4.0, Vec3{0.0}))[2], Vec3(0.0, 0.0, -1.0)),
            1e-15);
}

TEST(WidgetText, RefusesNonsense) {
  GridFrame frame;
  for (const char* text : {"", "grid", "plane:0,0,0,1", "plane:1,0,0", "axes:1,0,0,2,0,0", "plane:nan,0,0,1"})
    EXPECT_TRUE(read_text(text, frame)) << text;
  GridMarks marks;
  for (const char* text : {"x", "x:", "w:1", "x:1/", "x:inf", "plane:0,0,0,1", "x:1,2"})
    EXPECT_TRUE(read_text(text, marks)) << text;
  std::string many = "x:1";
  for (int i = 0; i < GridMarks::kMax; ++i) many += "/x:1";
  EXPECT_TRUE(read_text(many, marks));
  PlanePoses poses;
  for (const char* text : {"1", "0,0,0,1", "1,2,3,0,0,0,2", "1,0,0,1/", "1,0,0,nan"})
    EXPECT_TRUE(read_text(text, poses)) << text;
  EXPECT_TRUE(read_text("1,0,0,1/1,0,0,1/1,0,0,1/1,0,0,1/1,0,0,1", poses));
}

}  // namespace
}  // namespace palpate
