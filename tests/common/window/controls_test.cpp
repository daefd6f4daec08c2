#include <cmath>
#include <numbers>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/window/background_job.h"
#include "common/window/controls/seed_choice.h"
#include "common/window/controls/view_control.h"
#include "common/window/keys.h"
#include "common/window/panels/panel.h"

namespace palpate {
namespace {

const Box kBox{Vec3(-1.0), Vec3(1.0)};
const PictureArea kArea{100.0, 50.0, 400.0, 200.0};

TEST(EventsOfFrame, LeavePressAndReleaseAFrameEach) {
  constexpr int kLetter = 'A', kF12 = 301;
  const InputEvent move{.kind = InputKind::kMove}, press{.kind = InputKind::kPress},
      release{.kind = InputKind::kRelease}, wheel{.kind = InputKind::kWheel},
      down{.kind = InputKind::kKeyDown, .key = kLetter}, up{.kind = InputKind::kKeyUp, .key = kLetter},
      other{.kind = InputKind::kKeyDown, .key = kLetter + 1}, off{.kind = InputKind::kKeyDown, .key = kF12};
  const auto shares = [](std::vector<InputEvent> events) {
    std::vector<std::size_t> counts;
    while (!events.empty()) {
      counts.push_back(events_of_frame(events));
      if (counts.back() == 0) break;  // would never end
      events.erase(events.begin(), events.begin() + static_cast<std::ptrdiff_t>(counts.back()));
    }
    return counts;
  };
  using Counts = std::vector<std::size_t>;
  EXPECT_EQ(shares({}), Counts{});
  EXPECT_EQ(shares({move, move, wheel, wheel, move}), Counts{5});
  EXPECT_EQ(shares({move, press, release, move, move}), (Counts{2, 1, 2})) << "the mouse is led on after it";
  EXPECT_EQ(shares({press, release, press, release}), (Counts{1, 1, 1, 1})) << "a double click";
  EXPECT_EQ(shares({press, move, move, release}), (Counts{1, 3})) << "a drag";
  EXPECT_EQ(shares({press, release, down, up}), (Counts{1, 1, 1, 1})) << "keys wait for what a press opens";
  EXPECT_EQ(shares({down, other, down, up, down}), (Counts{3, 1, 1})) << "a key that repeats, then again";
  EXPECT_EQ(shares({press, release, move, off, press}), Counts{5}) << "the force goes off at once";
}

TEST(ModifiersAfter, CountTheKeyOfAModifierItself) {
  constexpr int kControl = 341, kRightShift = 344, kDown = 3;
  const auto after = [](InputKind kind, int key, int modifiers) {
    return modifiers_after({.kind = kind, .key = key, .modifiers = modifiers});
  };
  EXPECT_EQ(after(InputKind::kKeyDown, kControl, 0), kModifierControl);
  EXPECT_EQ(after(InputKind::kKeyUp, kControl, kModifierControl), 0);
  EXPECT_EQ(after(InputKind::kKeyDown, kRightShift, kModifierControl), kModifierControl | kModifierShift);
  EXPECT_EQ(after(InputKind::kKeyUp, kRightShift, kModifierControl | kModifierShift), kModifierControl);
  EXPECT_EQ(after(InputKind::kKeyDown, 'Z', kDown), kDown);
}

class ViewControlTest : public ::testing::Test {
 protected:
  bool send(InputKind kind, double x, double y, MouseButton button = MouseButton::kLeft) {
    return control_.handle({.kind = kind, .x = x, .y = y, .button = button}, kArea, kBox, camera_);
  }
  bool move(double x, double y) { return send(InputKind::kMove, x, y); }
  bool press(MouseButton button) { return send(InputKind::kPress, 0, 0, button); }
  bool release(MouseButton button) { return send(InputKind::kRelease, 0, 0, button); }

  ViewControl control_;
  Camera camera_ = make_camera(kBox, {}, 2.0);
  const Camera before_ = camera_;
};

TEST_F(ViewControlTest, LeftDragTurnsAboutTheFocalPoint) {
  move(200, 100);
  press(MouseButton::kLeft);
  EXPECT_TRUE(move(300, 100));  // half the picture's height: a quarter of a turn
  EXPECT_EQ(camera_.focal_point, before_.focal_point);
  EXPECT_NEAR(glm::dot(camera_.axes[2], before_.axes[2]), 0.0, 1e-12);
  EXPECT_LT(glm::distance(camera_.axes[1], before_.axes[1]), 1e-12);
}

TEST_F(ViewControlTest, DraggingThereAndBackReturns) {
  move(200, 100);
  press(MouseButton::kLeft);
  move(260, 100);
  move(200, 100);
  EXPECT_LT(glm::distance(camera_.axes[2], before_.axes[2]), 1e-14);
}

TEST_F(ViewControlTest, LooksAlongAnAxisUprightAndThenFromTheOtherSide) {
  const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  struct Look {
    Command command;
    Vec3 from, up;
  };
  roll(camera_, 0.3);
  for (const auto& [command, from, up] : {Look{Command::kLookAlongX, x, z}, Look{Command::kLookAlongY, -y, z},
                                          Look{Command::kLookAlongZ, z, y}}) {
    for (const double side : {1.0, -1.0, 1.0}) {
      EXPECT_TRUE(ViewControl::look(command, kBox, 2.0, camera_));
      EXPECT_LT(glm::distance(camera_.axes[2], side * from), 1e-12)
          << static_cast<int>(command) << " " << side;
      EXPECT_LT(glm::distance(camera_.axes[1], up), 1e-12) << static_cast<int>(command) << " " << side;
    }
  }
  EXPECT_EQ(camera_.focal_point, kBox.center());
  EXPECT_FALSE(ViewControl::look(Command::kResetCamera, kBox, 2.0, camera_));
}

TEST_F(ViewControlTest, MiddleDragMovesTheFocalPlaneWithTheMouse) {
  const Vec3 point = camera_.focal_point;
  move(200, 100);
  press(MouseButton::kMiddle);
  EXPECT_TRUE(move(230, 80));
  const Vec3 shown = project(camera_, point, 400, 200);
  EXPECT_NEAR(shown.x, 200.0 + 30.0, 1e-9);
  EXPECT_NEAR(shown.y, 100.0 - 20.0, 1e-9);
}

TEST_F(ViewControlTest, RightDragUpwardsAndWheelEnlarge) {
  move(200, 100);
  press(MouseButton::kRight);
  EXPECT_TRUE(move(200, 80));
  EXPECT_LT(camera_.view_height, before_.view_height);
  release(MouseButton::kRight);
  const double height = camera_.view_height;
  EXPECT_TRUE(send(InputKind::kWheel, 0, 1));
  EXPECT_LT(camera_.view_height, height);
  EXPECT_TRUE(send(InputKind::kWheel, 0, -1));
  EXPECT_NEAR(camera_.view_height, height, 1e-12);
}

TEST_F(ViewControlTest, OnlyTheButtonThatBeganADragEndsIt) {
  move(200, 100);
  press(MouseButton::kLeft);
  press(MouseButton::kRight);
  release(MouseButton::kRight);
  EXPECT_TRUE(control_.dragging());
  release(MouseButton::kLeft);
  EXPECT_FALSE(control_.dragging());
  EXPECT_FALSE(move(250, 120));
  EXPECT_EQ(camera_, before_);
}

TEST_F(ViewControlTest, NothingHappensOutsideThePicture) {
  move(20, 20);
  press(MouseButton::kLeft);
  EXPECT_FALSE(send(InputKind::kWheel, 0, 3));
  EXPECT_FALSE(move(300, 100));
  EXPECT_EQ(camera_, before_);
}

TEST_F(ViewControlTest, ZoomStopsBeforeTheViewIsLost) {
  move(300, 150);
  for (int i = 0; i < 1000; ++i) send(InputKind::kWheel, 0, 5);
  EXPECT_GT(camera_.view_height, 1e-6);
  for (int i = 0; i < 1000; ++i) send(InputKind::kWheel, 0, -5);
  EXPECT_LT(camera_.view_height, 1e3);
  EXPECT_TRUE(is_finite(camera_.focal_point));
}

TEST(KeyBindings, AreThoseOfTheCheatSheetAndUnique) {
  std::set<std::pair<int, int>> seen;
  for (const KeyBinding& binding : key_bindings()) {
    EXPECT_TRUE(seen.insert({binding.key, binding.modifiers}).second) << binding.name;
    EXPECT_EQ(command_of({.kind = InputKind::kKeyDown, .key = binding.key, .modifiers = binding.modifiers}),
              binding.command);
    EXPECT_FALSE(command_of({.kind = InputKind::kKeyUp, .key = binding.key, .modifiers = binding.modifiers}));
  }
}

TEST(KeyBindings, ModifiersHaveToMatchButLocksDoNotCount) {
  constexpr int kCapsLock = 0x10;
  EXPECT_FALSE(command_of({.kind = InputKind::kKeyDown, .key = 'E'}));
  EXPECT_FALSE(command_of({.kind = InputKind::kKeyDown, .key = 'K', .modifiers = kModifierControl}));
  EXPECT_EQ(command_of({.kind = InputKind::kKeyDown, .key = 'Q', .modifiers = kCapsLock}), Command::kQuit);
}

TEST(SeedChoice, TextsAreReadAndWrittenBack) {
  for (const char* text : {"grid:4,5,6", "random:1000", "speed:300", "point:0,1,2", "seeds.csv", "grid:2,2",
                           "random:-3", "random:", "", "line:0,0,0,1,1,1,20"}) {
    EXPECT_EQ(seeds_text(seed_choice(text)), text);
  }
  EXPECT_EQ(seed_choice("grid:4,5,6").kind, SeedChoice::Kind::kGrid);
  EXPECT_EQ(seed_choice("random:1000").count, 1000);
  EXPECT_EQ(seed_choice("speed:300").kind, SeedChoice::Kind::kSpeed);
  EXPECT_EQ(seed_choice("grid:2,2").kind, SeedChoice::Kind::kText);
}

TEST(Layout, PartsFillTheWindowWithoutOverlap) {
  for (const int width : {1, 200, 900, 4000}) {
    for (const int height : {1, 100, 1000}) {
      const WindowLayout parts = layout(width, height, 14.0F);
      EXPECT_EQ(parts.picture.left, parts.panel_width);
      EXPECT_GE(parts.picture.width, 1.0);
      EXPECT_GE(parts.picture.height, 1.0);
      EXPECT_GE(parts.picture.width, std::floor(0.5 * width));
    }
  }
}

TEST(BackgroundJob, HandsOverWhatItMadeAndWakesTheWindow) {
  std::atomic<int> woken{0};
  BackgroundJob job([&] { ++woken; });
  EXPECT_FALSE(job.take());
  job.start([](Progress&) {
    SceneState scene;
    scene.seeds = 7;
    return scene;
  });
  std::optional<BackgroundJob::Outcome> outcome;
  while (!(outcome = job.take())) std::this_thread::yield();
  EXPECT_EQ(woken, 1);
  EXPECT_EQ(outcome->scene->seeds, 7U);
  EXPECT_FALSE(job.running());
}

TEST(BackgroundJob, CancelledJobEndsWithItsError) {
  BackgroundJob job([] {});
  job.start([](Progress& progress) -> SceneState {
    while (true) {
      progress.check();
      std::this_thread::yield();
    }
  });
  job.cancel();
  std::optional<BackgroundJob::Outcome> outcome;
  while (!(outcome = job.take())) std::this_thread::yield();
  EXPECT_FALSE(outcome->scene);
  EXPECT_THROW(std::rethrow_exception(outcome->error), Cancelled);
}

TEST(BackgroundJob, DestructionCancelsAndWaits) {
  bool ended = false;
  {
    BackgroundJob job([] {});
    job.start([&](Progress& progress) -> SceneState {
      while (!progress.cancelled()) std::this_thread::yield();
      ended = true;
      return {};
    });
  }
  EXPECT_TRUE(ended);
}

}  // namespace
}  // namespace palpate
