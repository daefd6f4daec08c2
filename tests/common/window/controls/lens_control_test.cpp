#include "common/window/controls/lens_control.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/half_space.h"

namespace palpate {
namespace {

const Box kBox{Vec3(-1.0), Vec3(1.0)};
const PictureArea kArea{100.0, 50.0, 400.0, 200.0};

class LensControlTest : public ::testing::Test {
 protected:
  bool send(const InputEvent& event) { return control_.handle(event, kArea, camera_, kBox, view_); }
  bool move(double x, double y) { return send({.kind = InputKind::kMove, .x = x, .y = y}); }
  bool wheel(double notches) { return send({.kind = InputKind::kWheel, .y = notches}); }
  std::string run(Command command) { return control_.run(command, kArea, camera_, kBox, model_, view_); }
  [[nodiscard]] Vec3 center() const { return center_of(view_.lenses.at(0).shape, Vec3(0.0)); }
  [[nodiscard]] double radius() const {
    const LineInterval inside = clip_line(view_.lenses.at(0).shape, center(), Vec3(0.0, 0.0, 1.0));
    return inside.last;
  }
  /// Where a point is drawn, in the window.
  [[nodiscard]] Vec3 shown(const Vec3& x) const {
    return project(camera_, x, 400, 200) + Vec3(kArea.left, kArea.top, 0.0);
  }

  LensControl control_;
  Camera camera_ = make_camera(kBox, {}, 2.0);
  VolumeView view_;
  Lens model_ = [] {
    Lens lens;
    lens.transfer = make_color_transfer(ColorPreset::kMr, 0.0, 1.0);
    lens.samples_per_voxel = 3.0;
    return lens;
  }();
};

TEST_F(LensControlTest, ALensBeginsUnderTheMouseAndFollowsIt) {
  move(250, 120);
  EXPECT_NE(run(Command::kLens).find("follows"), std::string::npos);
  ASSERT_EQ(view_.lenses.size(), 1U);
  EXPECT_EQ(view_.lenses[0].transfer, model_.transfer);
  EXPECT_EQ(view_.lenses[0].samples_per_voxel, 3.0);
  EXPECT_NEAR(radius(), 2.0 / 6.0, 1e-12);
  EXPECT_NEAR(shown(center()).x, 250.0, 1e-9);
  const double depth = shown(center()).z;
  move(310, 90);
  EXPECT_NEAR(shown(center()).x, 310.0, 1e-9);
  EXPECT_NEAR(shown(center()).y, 90.0, 1e-9);
  EXPECT_NEAR(shown(center()).z, depth, 1e-12);
  // Over the panel it waits.
  const Vec3 before = center();
  move(20, 90);
  EXPECT_EQ(center(), before);
}

// What the panel asks for: the first of two, seen as a circle.
TEST_F(LensControlTest, AnyLensIsTakenUpAndSeenAsACircle) {
  view_.lenses = {new_lens(model_, Vec3(0.2, 0.0, 0.1), kBox), new_lens(model_, Vec3(-0.4), kBox)};
  const Vec3 other = center_of(view_.lenses[1].shape, Vec3(0.0));
  (void)control_.follow(0);
  move(310, 90);
  EXPECT_NEAR(shown(center()).x, 310.0, 1e-9);
  EXPECT_EQ(center_of(view_.lenses[1].shape, Vec3(0.0)), other);
  const std::vector<Vec3> circle = outline_of(view_.lenses[0], camera_);
  ASSERT_GT(circle.size(), 12U);
  EXPECT_EQ(circle.front(), circle.back());
  for (const Vec3& x : circle) {
    EXPECT_NEAR(glm::distance(x, center()), radius(), 1e-12);
    EXPECT_NEAR(glm::dot(x - center(), camera_.axes[2]), 0.0, 1e-12);
  }
  EXPECT_TRUE(outline_of(new_screen_lens(model_), camera_).empty());
}

TEST_F(LensControlTest, AClickLeavesItAndTheKeyTakesItUpAgain) {
  move(250, 120);
  (void)run(Command::kLens);
  EXPECT_TRUE(send({.kind = InputKind::kPress}));
  EXPECT_FALSE(control_.followed());
  const Vec3 left = center();
  move(300, 150);
  EXPECT_EQ(center(), left);
  EXPECT_FALSE(send({.kind = InputKind::kPress})) << "the next press is the camera's";
  (void)run(Command::kLens);
  EXPECT_EQ(view_.lenses.size(), 1U);
  EXPECT_NEAR(shown(center()).x, 300.0, 1e-9);
  (void)run(Command::kLens);
  EXPECT_FALSE(control_.followed());
}

TEST_F(LensControlTest, TheWheelChangesItsSizeAndWithCtrlItsDepth) {
  EXPECT_FALSE(wheel(1.0)) << "without a lens the wheel zooms";
  move(250, 120);
  (void)run(Command::kLens);
  const double before = radius();
  const Vec3 place = center();
  EXPECT_TRUE(wheel(2.0));
  EXPECT_GT(radius(), 1.1 * before);
  EXPECT_TRUE(wheel(-2.0));
  EXPECT_NEAR(radius(), before, 1e-12);
  EXPECT_LT(glm::distance(center(), place), 1e-12);
  (void)send({.kind = InputKind::kKeyDown, .key = 341});
  EXPECT_TRUE(wheel(3.0));
  EXPECT_NEAR(radius(), before, 1e-12);
  EXPECT_GT(shown(center()).z, shown(place).z) << "away from the viewer";
  (void)send({.kind = InputKind::kKeyUp, .key = 341});
  for (int i = 0; i < 200; ++i) (void)wheel(1.0);
  EXPECT_LE(radius(), 2.001 * kBox.diagonal());
  for (int i = 0; i < 400; ++i) (void)wheel(-1.0);
  EXPECT_GE(radius(), 0.999e-3 * kBox.diagonal());
}

TEST_F(LensControlTest, KeysChangeItsSizeAndAHalfSpaceMovesAlongItsNormal) {
  EXPECT_NE(run(Command::kLensLarger).find("L begins one"), std::string::npos);
  view_.lenses.push_back({.shape = test::make_half_space(Vec3(0.2, 0.0, 0.0), Vec3(1.0, 0.0, 0.0))});
  const ConvexShape before = view_.lenses[0].shape;
  (void)run(Command::kLensLarger);
  EXPECT_EQ(view_.lenses[0].shape, before);
  (void)run(Command::kLens);
  move(320, 100);
  const ConvexShape::HalfSpace& face = view_.lenses[0].shape.half_spaces[0];
  EXPECT_EQ(face.outward, Vec3(1.0, 0.0, 0.0));
  EXPECT_NE(face.offset, before.half_spaces[0].offset);
  view_.lenses.assign(1, {.shape = make_sphere(Vec3(0.0), 0.25)});
  control_.let_go();
  (void)run(Command::kLensLarger);
  EXPECT_GT(radius(), 0.25);
  (void)run(Command::kLensSmaller);
  EXPECT_NEAR(radius(), 0.25, 1e-12);
}

TEST_F(LensControlTest, ACircleOnTheScreenFollowsTheMouseThere) {
  view_.lenses = {new_screen_lens(model_)};
  const ScreenCircle& circle = *view_.lenses[0].screen;
  EXPECT_EQ(view_.lenses[0].transfer, model_.transfer);
  move(kArea.left + 0.75 * kArea.width, kArea.top + 0.25 * kArea.height);
  (void)run(Command::kLens);
  EXPECT_NEAR(circle.x, 0.25 * kArea.width / kArea.height, 1e-12);
  EXPECT_NEAR(circle.y, 0.25, 1e-12) << "up";
  const double before = circle.radius;
  EXPECT_TRUE(wheel(2.0));
  EXPECT_GT(circle.radius, 1.1 * before);
  for (int i = 0; i < 200; ++i) (void)wheel(1.0);
  EXPECT_EQ(circle.radius, kLargestCircle);
  for (int i = 0; i < 400; ++i) (void)wheel(-1.0);
  EXPECT_EQ(circle.radius, kSmallestCircle);
}

TEST_F(LensControlTest, ALensThatThePanelTookAwayIsNotFollowed) {
  move(250, 120);
  (void)run(Command::kLens);
  view_.lenses.clear();
  EXPECT_FALSE(move(260, 120));
  EXPECT_FALSE(wheel(1.0));
  EXPECT_FALSE(control_.followed());
}

}  // namespace
}  // namespace palpate
