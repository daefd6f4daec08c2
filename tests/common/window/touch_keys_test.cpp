// Every key about touch, in the window.

#include <cmath>

#include "tests/common/window/touch_window.h"

namespace palpate::test {
namespace {

TEST_F(TouchWindowTest, GGrabsAtTheMouseAndLetsGo) {
  grab();
  const WindowResult held = run();
  EXPECT_TRUE(held.probe.held);
  EXPECT_EQ(held.probe.state, HoldState::kHeld);
  EXPECT_NE(held.message.find("grabbed"), std::string::npos) << held.message;
  ASSERT_TRUE(held.view.probe);
  EXPECT_TRUE(held.view.probe->followed);
  EXPECT_GT(held.view.probe->reference_speed, 0.0);
  key('G');
  const WindowResult free = run();
  EXPECT_FALSE(free.probe.held);
  EXPECT_EQ(free.message, "let go");
  EXPECT_TRUE(free.view.probe->followed) << "stays in the picture";
}

TEST_F(TouchWindowTest, AskedForOverThePanelItIsGrabbedByTheNextClickIntoThePicture) {
  move(next(), 20.0, middle_y_);
  key('G');
  const WindowResult asked = run();
  EXPECT_FALSE(asked.probe.held);
  EXPECT_NE(asked.message.find("click on a line"), std::string::npos) << asked.message;
  click(next(), middle_x_, middle_y_);
  last_ += kPause;
  const WindowResult held = run();
  EXPECT_TRUE(held.probe.held);
  EXPECT_EQ(held.view.camera.axes[2], asked.view.camera.axes[2]) << "that click is not the camera's";
}

TEST_F(TouchWindowTest, TheProbeStaysUnderTheMouse) {
  grab();
  const Vec3 start = run().probe.probe;
  lead_to(80.0, -50.0);
  const WindowResult result = run();
  constexpr float kTextHeight = 14.0F;
  const PictureArea area = layout(options_.width, options_.height, kTextHeight).picture;
  const auto shown = [&](const Vec3& x) {
    return project(result.view.camera, x, static_cast<int>(area.width), static_cast<int>(area.height));
  };
  EXPECT_NEAR(shown(result.probe.probe).x - shown(start).x, 80.0, 1e-6);
  EXPECT_NEAR(shown(result.probe.probe).y - shown(start).y, -50.0, 1e-6);
  EXPECT_LT(glm::distance(result.probe.probe, result.probe.proxy), 0.4) << "at the depth of its line";
  EXPECT_GT(result.view.probe->path.count, 20U);
}

TEST_F(TouchWindowTest, TheWheelPushesTheProbeAndLeavesTheView) {
  grab();
  const WindowResult before = run();
  at(next(), {.kind = InputKind::kWheel, .y = 3.0});
  const WindowResult after = run();
  const Vec3 step = after.probe.probe - before.probe.probe;
  EXPECT_LE(glm::distance(step, -0.06 * after.view.camera.view_height * after.view.camera.axes[2]), 1e-9);
  EXPECT_EQ(after.view.camera.view_height, before.view.camera.view_height);
}

TEST_F(TouchWindowTest, ShiftHoldsTheProbeAsLongAsItIsDown) {
  const int down = next();
  key_down(down, kShift, kModifierShift);
  last_ = down + kPause;
  const WindowResult held = run();
  EXPECT_TRUE(held.probe.held);
  key_up(next(), kShift);
  EXPECT_FALSE(run().probe.held);
}

TEST_F(TouchWindowTest, ShiftWithControlIsForACommand) {
  const int down = next();
  key_down(down, kControl);
  key_down(down + 2, kShift, kModifierControl);
  last_ = down + kPause;
  EXPECT_FALSE(run().probe.held);
  key_up(next(), kShift);
  key_up(next(), kControl);
  const int first = next();
  key_down(first, kShift);
  last_ = first + kPause;
  EXPECT_TRUE(run().probe.held);
  key_down(next(), kControl, kModifierShift);
  EXPECT_FALSE(run().probe.held);
}

TEST_F(TouchWindowTest, EscapeLetsGo) {
  grab();
  key(kEscape);
  const WindowResult result = run();
  EXPECT_FALSE(result.probe.held);
  EXPECT_EQ(result.message, "");
}

TEST_F(TouchWindowTest, ADragTurnsTheViewWhileTheProbeRests) {
  grab();
  const WindowResult before = run();
  at(next(), {.kind = InputKind::kPress});
  lead_to(100.0, 0.0);
  at(next(), {.kind = InputKind::kRelease});
  const WindowResult after = run();
  EXPECT_LE(glm::distance(after.probe.probe, before.probe.probe), 1e-9);
  EXPECT_GT(glm::distance(after.view.camera.axes[2], before.view.camera.axes[2]), 0.1);
}

TEST_F(TouchWindowTest, LinesAreKeptTakenBackAndSaved) {
  grab();
  lead_to(60.0, 20.0);
  key('K');
  lead_to(75.0, 25.0);
  key(' ');
  const WindowResult kept = run();
  ASSERT_TRUE(kept.view.probe->drawn_lines);
  EXPECT_EQ(kept.view.probe->drawn_lines->size(), 2U);
  EXPECT_EQ(kept.document.input.time, "") << "Space keeps, and does not play, while the probe is held";
  EXPECT_NE(kept.message.find("kept line 2"), std::string::npos);
  key('E', kModifierControl);
  const WindowResult saved = run();
  EXPECT_NE(saved.message.find("followed.vtp"), std::string::npos) << saved.message;
  EXPECT_NE(read_file(folder_.path("followed.vtp")).find("\"force\""), std::string::npos);
  std::filesystem::remove(folder_.path("followed.vtp"));
  key('Z', kModifierControl);
  const WindowResult undone = run();
  EXPECT_EQ(undone.message, "undone");
  EXPECT_EQ(undone.view.probe->drawn_lines->size(), 1U);
  key('Z', kModifierControl | kModifierShift);
  const WindowResult restored = run();
  EXPECT_EQ(restored.message, "restored");
  EXPECT_EQ(restored.view.probe->drawn_lines->size(), 2U);
}

// One order for all: a line is kept, the mode is changed, another step in time is shown.
TEST_F(TouchWindowTest, KeptLinesAreInTheSameOrderOfEditsAsAllElse) {
  grab();
  key('K');
  key('G');
  key('2');
  key('.');
  const auto state = [&] {
    const WindowResult result = run();
    return std::to_string(result.view.probe->drawn_lines->size()) + " " + result.document.touch.mode + " " +
           result.document.input.time;
  };
  const std::string all = state();
  EXPECT_TRUE(all.starts_with("1 ")) << all << ": another step in time keeps the line";
  key('Z', kModifierControl);
  const std::string earlier = state();
  EXPECT_NE(earlier, all);
  EXPECT_TRUE(earlier.starts_with("1 isotropic")) << earlier;
  key('Z', kModifierControl);
  EXPECT_TRUE(state().starts_with("1 ") && state().find("isotropic") == std::string::npos) << state();
  key('Z', kModifierControl);
  EXPECT_TRUE(state().starts_with("0 ")) << state();
  for (int i = 0; i < 3; ++i) key('Y', kModifierControl);
  EXPECT_EQ(state(), all);
}

TEST_F(TouchWindowTest, TheSessionHasTheLinesAndTheWindowClosesUnasked) {
  model_.file = folder_.path("helix.vtk");
  grab();
  key('K');
  lead_to(60.0, 20.0);
  key('K');
  key('S', kModifierControl);
  const WindowResult saved = run();
  EXPECT_NE(saved.message.find("with 2 lines"), std::string::npos) << saved.message;
  EXPECT_EQ(model_.saved.touch.drawn_lines, folder_.path("helix.palpate.lines.csv"));
  const auto lines = read_drawn_lines(model_.saved.touch.drawn_lines);
  ASSERT_EQ(lines->size(), 2U);
  EXPECT_EQ((*lines)[1].number, 2);
  EXPECT_EQ((*lines)[1].line->points.size(), (*saved.view.probe->drawn_lines)[1].line->points.size());
  key('Q');
  last_ += 4 * kPause;
  EXPECT_LT(run().frames, options_.frames) << "closes unasked";

  // Opened with them, they are there with their numbers, and unsaved lines are asked about.
  options_.script.clear();
  last_ = 0;
  options_.touch.lines = lines;
  move(1, middle_x_, middle_y_);
  key('Q');
  last_ += 4 * kPause;
  EXPECT_LT(run().frames, options_.frames) << "they are in a file";
  options_.script.clear();
  last_ = 0;
  grab();
  key('K');
  const WindowResult more = run();
  ASSERT_EQ(more.view.probe->drawn_lines->size(), 3U);
  EXPECT_EQ(more.view.probe->drawn_lines->back().number, 3);
  key('Q');
  last_ += 4 * kPause;
  EXPECT_EQ(run().frames, options_.frames) << "asked";
}

TEST_F(TouchWindowTest, AnotherInputForgetsTheLines) {
  grab();
  key('K');
  key('E', kModifierControl);
  at(next(), {.kind = InputKind::kDrop, .files = {"other.vtk"}});
  last_ += 2 * kPause;
  const WindowResult result = run();
  EXPECT_TRUE(!result.view.probe->drawn_lines || result.view.probe->drawn_lines->empty());
}

TEST_F(TouchWindowTest, ASliderTakesATypedNumberAndItsDigitsChooseNoMode) {
  press("FORCES");
  const int begin = next();
  // The window system gives with a key what was held before it.
  key_down(begin, kControl);
  at_control(begin + 2, {.kind = InputKind::kPress}, "stiffness");
  at(begin + 4, {.kind = InputKind::kRelease});
  at(begin + 6, {.kind = InputKind::kKeyUp, .key = kControl, .modifiers = kModifierControl});
  int frame = begin + 8;
  for (const char digit : {'3', '2', '1'}) {
    key_down(frame, digit);
    at(frame, {.kind = InputKind::kText, .key = digit});
    key_up(frame + 1, digit);
    frame += 3;
  }
  key_down(frame, kEnter);
  key_up(frame + 1, kEnter);
  const WindowResult typed = run();
  EXPECT_EQ(typed.document.touch.stiffness, 321.0);
  EXPECT_NE(typed.document.touch.mode, "isotropic");
  key('2');
  const WindowResult chosen = run();
  EXPECT_EQ(chosen.document.touch.mode, "isotropic") << "once the field is left, keys are keys again";
  EXPECT_EQ(chosen.document.touch.stiffness, 321.0);
}

TEST_F(TouchWindowTest, TheLastLineCanBeKeptAfterLettingGoAndOnlyOnce) {
  grab();
  lead_to(60.0, 20.0);
  key('G');
  key('K');
  const WindowResult kept = run();
  EXPECT_NE(kept.message.find("kept line 1"), std::string::npos) << kept.message;
  key('K');
  const WindowResult again = run();
  EXPECT_NE(again.message.find("kept already"), std::string::npos) << again.message;
  ASSERT_TRUE(again.view.probe->drawn_lines);
  EXPECT_EQ(again.view.probe->drawn_lines->size(), 1U);
}

TEST_F(TouchWindowTest, ThePanelKeepsTheLineOnWhichTheHandRestedBeforeItWentThere) {
  constexpr int kRested = 60;  // frames, half a second
  grab();
  last_ += kRested;
  const auto script = options_.script;
  const int last = last_;
  key('K');
  const WindowResult rested = run();
  ASSERT_EQ(rested.view.probe->drawn_lines->size(), 1U);
  options_.script = script;
  last_ = last;
  // Across other lines, fast.
  constexpr int kSteps = 24;
  const int begin = last_ + 1;
  for (int i = 1; i <= kSteps; ++i) move_by(begin + i, -240.0 * i / kSteps, 60.0 * i / kSteps);
  at_control(last_ + 1, {.kind = InputKind::kMove}, "Keep line");
  at(last_ + 1, {.kind = InputKind::kPress});
  at(last_ + 2, {.kind = InputKind::kRelease});
  const WindowResult result = run();
  EXPECT_NE(result.message.find("kept line 1"), std::string::npos) << result.message;
  ASSERT_EQ(result.view.probe->drawn_lines->size(), 1U);
  const Line &meant = *rested.view.probe->drawn_lines->front().line,
             &kept = *result.view.probe->drawn_lines->front().line;
  const auto near = [&](const Line& line) {
    double nearest = HUGE_VAL;
    for (const LinePoint& p : line.points) {
      nearest = std::min(nearest, glm::distance(p.position, meant.points[meant.points.size() / 2].position));
    }
    return nearest;
  };
  EXPECT_LT(near(kept), 0.02) << "that line, though it may have grown meanwhile";
  EXPECT_GT(result.probe.popped, 0) << "there were others on the way";
}

TEST_F(TouchWindowTest, AWordIsSaidWhenTheProbePopsOver) {
  grab();
  lead_to(0.0, 80.0);
  const WindowResult result = run();
  EXPECT_GT(result.probe.popped, 0);
  EXPECT_NE(result.message.find("popped over"), std::string::npos) << result.message;
}

TEST_F(TouchWindowTest, ThereMustBeALineToKeepAndOneToSave) {
  key('K');
  EXPECT_NE(run().message.find("no line is followed"), std::string::npos);
  key('E', kModifierControl);
  EXPECT_NE(run().message.find("no line is kept"), std::string::npos);
}

TEST_F(TouchWindowTest, AForeignFileOfLinesIsNotReplaced) {
  folder_.write("followed.vtp", "mine");
  grab();
  key('K');
  key('E', kModifierControl);
  const WindowResult result = run();
  EXPECT_NE(result.message.find("followed-2.vtp"), std::string::npos) << result.message;
  EXPECT_EQ(read_file(folder_.path("followed.vtp")), "mine");
}

TEST_F(TouchWindowTest, SpacePlaysWhileTheProbeIsFree) {
  grab();
  key('G');
  key(' ');
  const WindowResult result = run();
  EXPECT_GT(model_.updated, 0);
  EXPECT_TRUE(!result.view.probe->drawn_lines || result.view.probe->drawn_lines->empty());
}

TEST_F(TouchWindowTest, RShowsARakeThenAPlaneThenNothing) {
  grab();
  const auto shape = [&] {
    const WindowResult result = run();
    return result.view.probe->seeds ? result.view.probe->seeds->shape : SeedShape::kNone;
  };
  for (const SeedShape expected : {SeedShape::kRake, SeedShape::kPlane, SeedShape::kNone}) {
    key('R');
    last_ += 2 * kPause;  // they are traced on a thread of their own
    EXPECT_EQ(shape(), expected);
  }
}

TEST_F(TouchWindowTest, AxesLockTheProbe) {
  key('X');
  EXPECT_NE(run().message.find("grab the probe first"), std::string::npos);
  grab();
  const Vec3 start = run().probe.probe;
  const auto script = options_.script;
  const int last = last_;
  for (int axis = 0; axis < 3; ++axis) {
    options_.script = script;
    last_ = last;
    from_x_ = from_y_ = 0.0;
    key('X' + axis);
    const std::string answer = run().message;
    EXPECT_NE(answer.find(std::string("along ") + "xyz"[axis]), std::string::npos) << answer;
    lead_to(50.0, 40.0);
    const WindowResult result = run();
    for (int other = 0; other < 3; ++other) {
      const double way = std::abs(result.probe.probe[other] - start[other]);
      if (other == axis) {
        EXPECT_GT(way, 1e-3) << axis;
      } else {
        EXPECT_LE(way, 1e-12) << axis;
      }
    }
  }
  key('Z');
  EXPECT_EQ(run().message, "the probe moves freely");
}

TEST_F(TouchWindowTest, F12TakesTheForceAwayAtOnce) {
  grab();
  lead_to(10.0, 0.0);
  const WindowResult before = run();
  EXPECT_GT(before.probe.force, 0.05);
  key(kF12);
  const WindowResult after = run();
  EXPECT_EQ(after.probe.force, 0.0);
  EXPECT_EQ(after.probe.cut, ForceCut::kSwitchedOff);
  EXPECT_FALSE(after.probe.servo.armed);
  EXPECT_NE(after.message.find("force off"), std::string::npos);
}

TEST_F(TouchWindowTest, DigitsChooseTheMode) {
  grab();
  key('2');
  const WindowResult second = run();
  EXPECT_NE(second.message.find("isotropic"), std::string::npos);
  EXPECT_FALSE(second.view.probe->followed);
  EXPECT_TRUE(second.probe.held) << "and leave the probe in the hand";
  key('1');
  EXPECT_TRUE(run().view.probe->followed);
  key('3');
  EXPECT_EQ(run().message, "there is no mode 3");
}

// A long stall would be felt. On a busy machine frames come late now and then: the bound is generous.
TEST_F(TouchWindowTest, FramesKeepComingWhileTheServoRuns) {
  grab();
  for (int i = 1; i <= 10; ++i) lead_to(60.0 * std::sin(0.6 * i), 60.0 * std::cos(0.6 * i));
  const WindowResult result = run();
  EXPECT_TRUE(result.probe.held);
  EXPECT_GT(result.probe.servo.statistics.ticks, 1000U);
  std::vector<double> gaps;
  // The first frames open the scene.
  for (std::size_t i = 20; i < frame_times_.size(); ++i)
    gaps.push_back(frame_times_[i] - frame_times_[i - 1]);
  ASSERT_GT(gaps.size(), 200U);
  std::sort(gaps.begin(), gaps.end());
  EXPECT_LT(gaps.back(), std::max(100.0 * gaps[gaps.size() / 2], 3000.0));
}

}  // namespace
}  // namespace palpate::test
