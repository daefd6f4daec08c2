// Slices and the mouse: what moves them, what is left to the camera, and what keys do whichever way the
// voxels are counted.

#include "common/window/controls/slice_control.h"

#include <gtest/gtest.h>

#include "tests/common/render/tensor/sample_tensors.h"

namespace palpate::test {
namespace {

constexpr int kControl = 341;

class SliceControlTest : public ::testing::Test {
 protected:
  bool send(InputEvent event) { return control_.handle(event, area_, camera_, view_); }
  bool press(MouseButton button = MouseButton::kLeft) {
    return send({.kind = InputKind::kPress, .button = button});
  }
  bool release(MouseButton button = MouseButton::kLeft) {
    return send({.kind = InputKind::kRelease, .button = button});
  }
  bool wheel(double notches) { return send({.kind = InputKind::kWheel, .y = notches}); }
  void control(bool down) { send({.kind = down ? InputKind::kKeyDown : InputKind::kKeyUp, .key = kControl}); }
  bool move(double x, double y) { return send({.kind = InputKind::kMove, .x = x, .y = y}); }
  /// To where a place of the image is drawn; in the middle of a voxel nothing hangs on the last bit.
  bool move_to(const Vec3& g) {
    const Vec3 p = project(camera_, view_.image->position(g), static_cast<int>(area_.width),
                           static_cast<int>(area_.height));
    return move(area_.left + p.x, area_.top + p.y);
  }
  [[nodiscard]] Vec3 place() const { return view_.image->grid_coordinates(view_.position); }

  /// The first axis of the image runs to the left: what goes to the right goes to lower indices.
  static TensorView sample() {
    const Mat3 axes{Vec3{-2.0, 0.0, 0.0}, Vec3{0.0, 2.0, 0.0}, Vec3{0.0, 0.0, 3.0}};
    const auto image = sampled_tensors(centred_lattice({21, 19, 15}, axes), [](const Vec3&) {
      return linear_tensor({1.0, 0.0, 0.0});
    });
    TensorView view{.image = image, .position = image->position({10.0, 9.0, 7.0})};
    view.slices = {false, false, true};
    return view;
  }

  TensorView view_ = sample();
  PictureArea area_{100.0, 20.0, 600.0, 400.0};
  Camera camera_ = make_camera(view_.image->bounds(), {.azimuth = 0.0, .elevation = 90.0}, 1.5);
  SliceControl control_;
};

TEST_F(SliceControlTest, TheWheelMovesTheSliceUnderTheMouseAwayFromTheViewer) {
  move_to({4.0, 5.0, 7.0});
  EXPECT_TRUE(wheel(1.0));
  EXPECT_NEAR(place().z, 6.0, 1e-12) << "seen from above, away is down";
  EXPECT_TRUE(wheel(-1.0));
  EXPECT_TRUE(wheel(-1.0));
  EXPECT_NEAR(place().z, 8.0, 1e-12);
  EXPECT_NEAR(place().x, 10.0, 1e-12);
  camera_ = make_camera(view_.image->bounds(), {.azimuth = 0.0, .elevation = -90.0}, 1.5);
  move_to({4.0, 5.0, 8.0});
  EXPECT_TRUE(wheel(1.0));
  EXPECT_NEAR(place().z, 9.0, 1e-12) << "from below, away is up";
}

TEST_F(SliceControlTest, TheWheelIsTheCamerasBesideSlicesAndWithControl) {
  move_to({40.0, 9.0, 7.0});
  EXPECT_FALSE(wheel(1.0));
  move_to({4.0, 5.0, 7.0});
  control(true);
  EXPECT_FALSE(wheel(1.0));
  control(false);
  EXPECT_FALSE(wheel(0.0));
  EXPECT_NEAR(place().z, 7.0, 1e-12);
  EXPECT_TRUE(wheel(1.0));
}

TEST_F(SliceControlTest, TheSliceStopsAtTheImagesEnd) {
  for (int i = 0; i < 30; ++i) {
    move_to({10.0, 9.0, place().z});
    EXPECT_TRUE(wheel(1.0));
  }
  EXPECT_NEAR(place().z, 0.0, 1e-12);
}

TEST_F(SliceControlTest, AClickPutsTheCrosshairThere) {
  move_to({4.0, 5.0, 7.0});
  EXPECT_FALSE(press()) << "it may become a turn of the camera";
  EXPECT_NEAR(place().x, 10.0, 1e-12);
  EXPECT_FALSE(release());
  EXPECT_NEAR(place().x, 4.0, 1e-9);
  EXPECT_NEAR(place().y, 5.0, 1e-9);
  EXPECT_NEAR(place().z, 7.0, 1e-9);
}

TEST_F(SliceControlTest, ADragOrAnotherButtonIsTheCameras) {
  move_to({4.0, 5.0, 7.0});
  press();
  EXPECT_FALSE(move_to({12.0, 5.0, 7.0}));
  move_to({4.0, 5.0, 7.0});  // back again, but it was a drag
  EXPECT_FALSE(release());
  EXPECT_FALSE(press(MouseButton::kRight));
  EXPECT_FALSE(release(MouseButton::kRight));
  EXPECT_NEAR(place().x, 10.0, 1e-12);
}

TEST_F(SliceControlTest, WithControlTheCrosshairFollowsTheDrag) {
  control(true);
  move_to({4.0, 5.0, 7.0});
  EXPECT_TRUE(press());
  EXPECT_NEAR(place().x, 4.0, 1e-9);
  EXPECT_TRUE(control_.dragging());
  EXPECT_TRUE(move_to({12.0, 6.0, 7.0}));
  EXPECT_NEAR(place().x, 12.0, 1e-9);
  move_to({40.0, 9.0, 7.0});  // beside the slice it stays where it was
  EXPECT_NEAR(place().x, 12.0, 1e-9);
  EXPECT_TRUE(release());
  EXPECT_FALSE(control_.dragging());
}

TEST_F(SliceControlTest, NothingOutsideThePictureCounts) {
  control(true);
  move(50.0, 200.0);
  EXPECT_FALSE(press());
  EXPECT_FALSE(wheel(1.0));
  EXPECT_FALSE(control_.under_mouse(area_, camera_, view_));
  EXPECT_NEAR(glm::distance(place(), Vec3(10.0, 9.0, 7.0)), 0.0, 1e-12);
}

TEST_F(SliceControlTest, KeysMoveByAVoxelTowardTheSideTheyName) {
  EXPECT_TRUE(SliceControl::run(Command::kSliceRight, view_));
  EXPECT_NEAR(place().x, 9.0, 1e-12) << "this image's first axis runs to the left";
  EXPECT_TRUE(SliceControl::run(Command::kSliceLeft, view_));
  EXPECT_TRUE(SliceControl::run(Command::kSliceLeft, view_));
  EXPECT_NEAR(place().x, 11.0, 1e-12);
  EXPECT_TRUE(SliceControl::run(Command::kSliceFront, view_));
  EXPECT_NEAR(place().y, 10.0, 1e-12);
  EXPECT_TRUE(SliceControl::run(Command::kSliceBack, view_));
  EXPECT_NEAR(place().y, 9.0, 1e-12);
  EXPECT_TRUE(SliceControl::run(Command::kSliceUp, view_));
  EXPECT_NEAR(place().z, 8.0, 1e-12);
  EXPECT_TRUE(SliceControl::run(Command::kSliceDown, view_));
  EXPECT_NEAR(place().z, 7.0, 1e-12);
  EXPECT_FALSE(SliceControl::run(Command::kGrab, view_));
}

TEST_F(SliceControlTest, CrosshairAndSlicesLeadEachOther) {
  SceneView view;
  view.tensors = view_;
  view.volume.emplace().image = make_anisotropy_volume(view_.image);
  Vec3 &cross = view.volume->panes.cross, &place = view.tensors->position;
  cross = {4.0, 4.0, 4.0};
  CrosshairLink link;
  link.follow(view);
  EXPECT_NE(cross, place) << "with the picture alone each is by itself";
  view.volume->panes.layout = 4;
  link.follow(view);
  EXPECT_EQ(cross, place);
  EXPECT_NE(cross, Vec3(4.0)) << "slices that appear go where the tensors' are";
  cross = {4.0, 4.0, 4.0};
  link.follow(view);
  EXPECT_EQ(place, Vec3(4.0));
  place = {-2.0, 0.0, 3.0};
  link.follow(view);
  EXPECT_EQ(cross, Vec3(-2.0, 0.0, 3.0));
  cross = {1e3, 0.0, 0.0};
  link.follow(view);
  EXPECT_EQ(cross, place) << "outside the image is no place for it";
}

}  // namespace
}  // namespace palpate::test
