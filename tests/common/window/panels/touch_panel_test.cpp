// Every control of the panel about touch, clicked in the window.

#include <cmath>
#include <numeric>

#include <stb_image.h>

#include "apps/flow/flow_model.h"
#include "tests/common/window/touch_window.h"

namespace palpate::test {
namespace {

class TouchPanelTest : public TouchWindowTest {
 protected:
  /// The mode that follows nothing.
  void choose_other_mode() { choose("mode", options_.touch.modes[1].name); }
};

TEST_F(TouchPanelTest, GrabLetsAClickIntoThePictureTakeTheProbeThere) {
  press("Grab");
  click(next(), middle_x_, middle_y_);
  last_ += kPause;
  const WindowResult held = run();
  EXPECT_TRUE(held.probe.held);
  EXPECT_EQ(held.probe.state, HoldState::kHeld);
  press("Let go");
  EXPECT_FALSE(run().probe.held);
}

TEST_F(TouchPanelTest, ForceGoesOffAndOnAgain) {
  press("Force off");
  EXPECT_FALSE(run().probe.servo.armed);
  press("Force on again");
  EXPECT_TRUE(run().probe.servo.armed);
}

TEST_F(TouchPanelTest, TheModeIsChosen) {
  choose_other_mode();
  grab();
  const WindowResult result = run();
  EXPECT_TRUE(result.probe.held);
  EXPECT_FALSE(result.view.probe->followed);
}

TEST_F(TouchPanelTest, StiffnessIsForceOverStretch) {
  press("FORCES");
  press("stiffness", 0, kLeast);
  grab();
  lead_to(20.0, 0.0);
  const WindowResult result = run();
  EXPECT_EQ(result.probe.state, HoldState::kHeld);
  EXPECT_GT(result.probe.stretch, 0.5);
  EXPECT_NEAR(result.probe.force / result.probe.stretch, 10.0 * 1e-3, 1e-9) << "10 N/m is the least";
}

TEST_F(TouchPanelTest, ALineThatLetsGoLaterIsStretchedFarther) {
  grab();
  lead_to(0.0, 30.0);
  EXPECT_LE(run().probe.stretch, 10.0);
  options_.script.clear();
  last_ = 1;
  from_x_ = from_y_ = 0.0;
  press("FORCES");
  press("release", 0, kMost);
  grab();
  lead_to(0.0, 30.0);
  EXPECT_GT(run().probe.stretch, 12.0);
}

TEST_F(TouchPanelTest, DragIsHowFarTheProxyLagsBehind) {
  choose_other_mode();
  grab();
  lead_to(100.0, 0.0);
  EXPECT_NEAR(run().probe.stretch, 4.0, 1e-6);
  options_.script.clear();
  last_ = 1;
  from_x_ = from_y_ = 0.0;
  choose_other_mode();
  press("FORCES");
  press("drag", 0, kLeast);
  grab();
  lead_to(100.0, 0.0);
  EXPECT_NEAR(run().probe.stretch, 0.0, 1e-6);
}

TEST_F(TouchPanelTest, SpeedIsFeltAsAForceAlongTheLine) {
  grab();
  EXPECT_LT(run().probe.force, 0.01) << "on the line";
  options_.script.clear();
  last_ = 1;
  press("FORCES");
  press("speed force", 0, kMost);
  grab();
  EXPECT_GT(run().probe.force, 0.2);
}

TEST_F(TouchPanelTest, TickMarksAreASecondLink) {
  press("FORCES");
  press("tick marks");
  grab();
  EXPECT_EQ(run().probe.servo.hand.chain.links, 2);
}

TEST_F(TouchPanelTest, AClickCountsThoughTheMouseIsElsewhereBeforeTheNextFrame) {
  press("FORCES");
  const int frame = next();
  at_control(frame, {.kind = InputKind::kPress}, "tick marks");
  at(frame, {.kind = InputKind::kRelease});
  move_by(frame, 0.0, 0.0);
  grab();
  EXPECT_EQ(run().probe.servo.hand.chain.links, 2);
}

TEST_F(TouchPanelTest, BallsAndPathAreSwitchedOff) {
  grab();
  lead_to(40.0, 0.0);
  const WindowResult with = run();
  EXPECT_FALSE(with.view.probe->followed->balls.empty());
  EXPECT_TRUE(with.view.probe->path.points);
  options_.script.clear();
  last_ = 1;
  from_x_ = from_y_ = 0.0;
  press("stream balls");
  press("path");
  grab();
  lead_to(40.0, 0.0);
  const WindowResult without = run();
  EXPECT_TRUE(without.view.probe->followed->balls.empty());
  EXPECT_FALSE(without.view.probe->path.points);
}

TEST_F(TouchPanelTest, OtherLinesFadeWhileTheProbeIsHeldUnlessToldNotTo) {
  options_.screenshot = folder_.path("window.png");
  const auto brightness = [&] {
    (void)run();
    int width = 0, height = 0, channels = 0;
    stbi_uc* const pixels = stbi_load(options_.screenshot.c_str(), &width, &height, &channels, 3);
    EXPECT_NE(pixels, nullptr);
    const double sum = std::accumulate(pixels, pixels + 3LL * width * height, 0.0);
    stbi_image_free(pixels);
    return sum;
  };
  grab();
  const double faded = brightness();
  options_.script.clear();
  last_ = 1;
  press("fade the other lines");
  grab();
  EXPECT_GT(brightness(), 1.01 * faded);
}

TEST_F(TouchPanelTest, LinesAboutTheProbeAreChosen) {
  for (const SeedShape shape : {SeedShape::kRake, SeedShape::kPlane}) {
    choose("about the probe", shape == SeedShape::kRake ? "rake" : "plane");
    grab();
    last_ += 2 * kPause;
    const WindowResult result = run();
    ASSERT_TRUE(result.view.probe->seeds);
    EXPECT_EQ(result.view.probe->seeds->shape, shape);
    options_.script.clear();
    last_ = 1;
  }
}

TEST_F(TouchPanelTest, LinesAreKeptDeletedAndSavedUnderTheNameThatIsTyped) {
  grab();
  lead_to(30.0, 10.0);
  key('G');
  press("Keep line");
  const WindowResult kept = run();
  ASSERT_TRUE(kept.view.probe->drawn_lines);
  EXPECT_EQ(kept.view.probe->drawn_lines->size(), 1U);
  const auto script = options_.script;
  const int last = last_;

  press("x");
  EXPECT_TRUE(run().view.probe->drawn_lines->empty());

  options_.script = script;
  last_ = last;
  press("Save lines");
  EXPECT_NE(run().message.find("saved"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder_.path("followed.vtp")));

  options_.script = script;
  last_ = last;
  press("##file");
  key('A', kModifierControl);
  int frame = next();
  for (const char letter : std::string("ok.csv")) {
    key_down(frame, letter == '.' ? '.' : letter - 'a' + 'A');  // K keeps nothing while text is written
    at(frame, {.kind = InputKind::kText, .key = letter});
    key_up(frame + 1, letter == '.' ? '.' : letter - 'a' + 'A');
    frame += 2;
  }
  press("Save lines");
  const WindowResult saved = run();
  EXPECT_NE(saved.message.find("ok.csv"), std::string::npos) << saved.message;
  EXPECT_NE(read_file(folder_.path("ok.csv")).find("force"), std::string::npos);
  EXPECT_EQ(saved.view.probe->drawn_lines->size(), 1U);
}

TEST_F(TouchPanelTest, OtherLinesOfTheSameFieldLeaveTheProbeInTheHand) {
  options_.panels = flow_panels();
  grow_to(1000);
  grab();
  press("tolerance", 0, kLeast);
  const WindowResult traced = run();
  EXPECT_GT(model_.updated, 0);
  EXPECT_EQ(traced.document.tracing.tolerance, 1e-12);
  EXPECT_TRUE(traced.probe.held);
}

TEST_F(TouchPanelTest, ThePathIsCleared) {
  grab();
  lead_to(80.0, 0.0);
  key('G');
  EXPECT_GT(run().view.probe->path.count, 20U);
  press("Clear path");
  EXPECT_LT(run().view.probe->path.count, 2U);
}

}  // namespace
}  // namespace palpate::test
