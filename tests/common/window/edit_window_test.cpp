// What is edited in a window is taken back and restored.
#include <chrono>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "common/render/camera.h"
#include "common/window/panels/panel.h"
#include "common/window/panels/seed_panel.h"
#include "tests/common/window/formula_window.h"

namespace palpate::test {
namespace {

constexpr int kEnter = 257;

class EditWindowTest : public FormulaWindow {
 protected:
  void undo(int frame) { key(frame, 'Z', kModifierControl); }
  void redo(int frame) { key(frame, 'Z', kModifierControl | kModifierShift); }
  /// Frames of 8 ms at least, which go on while the first update takes longer than they all, but is cancelled.
  void update_slowly() {
    model_.rests = 6000;
    options_.frames_wait = false;
    options_.frames = 160;
    options_.stop_requested = [] {
      std::this_thread::sleep_for(std::chrono::milliseconds(8));
      return false;
    };
  }
};

// A drag is one step, and so is a key; where it is seen from is none.
TEST_F(EditWindowTest, EditsAreTakenBackAndRestoredInTheirOrder) {
  options_.frames = 36;
  const double width = options_.view.style.width;
  at_control(2, {.kind = InputKind::kPress}, "line width", 0.3);
  for (int i = 0; i < 8; ++i) at_control(4 + i, {.kind = InputKind::kMove}, "line width", 0.4 + 0.05 * i);
  release(14, MouseButton::kLeft);
  key(18, '.');
  move(22, 600, 300);
  press(23, MouseButton::kLeft);
  for (int i = 0; i < 4; ++i) move(24 + i, 620 + 20 * i, 300);
  release(30, MouseButton::kLeft);
  const WindowResult edited = run_window(model_, options_);
  EXPECT_GT(edited.view.style.width, width + 1.0);
  EXPECT_EQ(edited.document.input.time, "0.5");
  const Vec3 seen_along = edited.view.camera.axes[2];
  EXPECT_GT(glm::distance(seen_along, make_camera({Vec3(-1.0), Vec3(1.0)}, {}, 1.0).axes[2]), 0.3);

  const auto expect = [&](const char* message, double thick, const char* time) {
    options_.frames = options_.script.back().frame + 6;
    const WindowResult result = run_window(model_, options_);
    EXPECT_EQ(result.message, message);
    EXPECT_EQ(result.view.style.width, thick);
    EXPECT_EQ(result.document.view.line_width.value_or(width), thick);
    EXPECT_EQ(result.document.input.time, time);
    EXPECT_LT(glm::distance(result.view.camera.axes[2], seen_along), 1e-9) << "the camera stays";
  };
  const double thick = edited.view.style.width;
  undo(36);
  expect("undone", thick, "");
  undo(42);
  expect("undone", width, "");
  undo(48);
  expect("nothing to undo", width, "");
  redo(54);
  expect("restored", thick, "");
  key(60, 'Y', kModifierControl);
  expect("restored", thick, "0.5");
  redo(66);
  expect("nothing to restore", thick, "0.5");
  undo(72);
  key(78, '.');  // another edit: what was undone is gone
  redo(84);
  expect("nothing to restore", thick, "0.5");
}

TEST_F(EditWindowTest, ANumberTypedIntoAFieldOfSeedsIsOneStep) {
  constexpr int kControl = 341;
  options_.frames = 60;
  options_.panels = {[](PanelContext& on) { draw_seeds(on.state, true); }};
  at(2, {.kind = InputKind::kKeyDown, .key = kControl});
  at_control(3, {.kind = InputKind::kPress}, "number");
  release(5, MouseButton::kLeft);
  at(7, {.kind = InputKind::kKeyUp, .key = kControl, .modifiers = kModifierControl});
  for (int i = 0; i < 2; ++i) {
    key(10 + 3 * i, '7');
    at(10 + 3 * i, {.kind = InputKind::kText, .key = '7'});
  }
  key(18, kEnter);
  const WindowResult typed = run_window(model_, options_);
  EXPECT_EQ(typed.document.tracing.seeds, "random:77");
  EXPECT_GT(model_.updated, 0);
  undo(30);
  EXPECT_EQ(run_window(model_, options_).document.tracing.seeds, "random:40");
  redo(40);
  const WindowResult restored = run_window(model_, options_);
  EXPECT_EQ(restored.document.tracing.seeds, "random:77");
  EXPECT_EQ(restored.message, "restored");
}

// The one that runs makes way for the next, and neither drops what was asked for.
TEST_F(EditWindowTest, AnEditWhileAnUpdateRunsIsKept) {
  update_slowly();
  key(5, '.');
  key(80, '.');  // after the patience with the first
  const WindowResult result = run_window(model_, options_);
  EXPECT_EQ(result.document.input.time, "1");
  EXPECT_EQ(model_.updated, 2);
}

TEST_F(EditWindowTest, UndoGoesThroughAnUpdate) {
  update_slowly();
  key(5, '.');
  undo(80);
  const WindowResult undone = run_window(model_, options_);
  EXPECT_EQ(undone.document.input.time, "");
  EXPECT_EQ(undone.message, "undone");
  redo(90);
  EXPECT_EQ(run_window(model_, options_).document.input.time, "0.5");
  at_control(100, {.kind = InputKind::kPress}, "line width", 0.9);
  release(102, MouseButton::kLeft);
  undo(110);
  const WindowResult result = run_window(model_, options_);
  EXPECT_EQ(result.document.input.time, "0.5") << "the step before";
  EXPECT_EQ(result.view.style.width, options_.view.style.width);
}

TEST_F(EditWindowTest, AnEditThatFailsIsNoStep) {
  options_.frames = 40;
  model_.refused = "1";
  key(4, '.');
  key(10, '.');
  const WindowResult failed = run_window(model_, options_);
  EXPECT_NE(failed.message.find("no such time"), std::string::npos) << failed.message;
  EXPECT_EQ(failed.document.input.time, "0.5");
  undo(20);
  EXPECT_EQ(run_window(model_, options_).document.input.time, "");
}

}  // namespace
}  // namespace palpate::test
