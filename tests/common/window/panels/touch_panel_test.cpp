// Every control of the panel about touch, clicked in the window.

#include <cmath>
#include <numeric>

#include <stb_image.h>

#include "tests/common/window/touch_window.h"

namespace palpate::test {
namespace {

/// Where the controls are [pixels]: rows of equal height below the heading.
constexpr double row(int i) { return 98.0 + 26.0 * i; }
constexpr int kFirstButtons = 0, kMode = 1, kStiffness = 2, kRelease = 3, kDrag = 4, kSpeedForce = 5,
              kTicks = 6, kBallsAndPath = 7, kFade = 8, kAbout = 9, kKeepAndClear = 10;
constexpr double kLeft = 72.0, kRight = 205.0;      // of two buttons
constexpr double kLeastOf = 14.0, kMostOf = 166.0;  // ends of a slider
constexpr double kBox = 20.0, kSecondBox = 139.0;   // check boxes
constexpr double kFileY = row(kKeepAndClear + 1);
constexpr double kKeptY = 407.0, kDeleteX = 218.0;  // of the first line that is kept
/// The items of a drop-down below it.
constexpr double item(int of_row, int i) { return row(of_row) + 26.0 + 20.0 * i; }

class TouchPanelTest : public TouchWindowTest {
 protected:
  void press(double x, double y) {
    const int frame = next();
    click(frame, x, y);
  }
  void choose(int of_row, int i) {
    press(kLeft, row(of_row));
    press(kLeft, item(of_row, i));
  }
};

TEST_F(TouchPanelTest, GrabLetsAClickIntoThePictureTakeTheProbeThere) {
  press(kLeft, row(kFirstButtons));
  press(middle_x_, middle_y_);
  last_ += kPause;
  const WindowResult held = run();
  EXPECT_TRUE(held.probe.held);
  EXPECT_EQ(held.probe.state, HoldState::kHeld);
  press(kLeft, row(kFirstButtons));
  EXPECT_FALSE(run().probe.held);
}

TEST_F(TouchPanelTest, ForceGoesOffAndOnAgain) {
  press(kRight, row(kFirstButtons));
  EXPECT_FALSE(run().probe.servo.armed);
  press(kRight, row(kFirstButtons));
  EXPECT_TRUE(run().probe.servo.armed);
}

TEST_F(TouchPanelTest, TheModeIsChosen) {
  choose(kMode, 1);
  grab();
  const WindowResult result = run();
  EXPECT_TRUE(result.probe.held);
  EXPECT_FALSE(result.view.probe->followed);
}

TEST_F(TouchPanelTest, StiffnessIsForceOverStretch) {
  press(kLeastOf, row(kStiffness));
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
  press(kMostOf, row(kRelease));
  grab();
  lead_to(0.0, 30.0);
  EXPECT_GT(run().probe.stretch, 12.0);
}

TEST_F(TouchPanelTest, DragIsHowFarTheProxyLagsBehind) {
  choose(kMode, 1);
  grab();
  lead_to(100.0, 0.0);
  EXPECT_NEAR(run().probe.stretch, 4.0, 1e-6);
  options_.script.clear();
  last_ = 1;
  from_x_ = from_y_ = 0.0;
  choose(kMode, 1);
  press(kLeastOf, row(kDrag));
  grab();
  lead_to(100.0, 0.0);
  EXPECT_NEAR(run().probe.stretch, 0.0, 1e-6);
}

TEST_F(TouchPanelTest, SpeedIsFeltAsAForceAlongTheLine) {
  grab();
  EXPECT_LT(run().probe.force, 0.01) << "on the line";
  options_.script.clear();
  last_ = 1;
  press(kMostOf, row(kSpeedForce));
  grab();
  EXPECT_GT(run().probe.force, 0.2);
}

TEST_F(TouchPanelTest, TickMarksAreASecondLink) {
  press(kBox, row(kTicks));
  grab();
  EXPECT_EQ(run().probe.servo.hand.chain.links, 2);
}

TEST_F(TouchPanelTest, AClickCountsThoughTheMouseIsElsewhereBeforeTheNextFrame) {
  const int frame = next();
  move(frame, kBox, row(kTicks));
  at(frame, {.kind = InputKind::kPress});
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
  press(kBox, row(kBallsAndPath));
  press(kSecondBox, row(kBallsAndPath));
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
  press(kBox, row(kFade));
  grab();
  EXPECT_GT(brightness(), 1.01 * faded);
}

TEST_F(TouchPanelTest, LinesAboutTheProbeAreChosen) {
  for (const SeedShape shape : {SeedShape::kRake, SeedShape::kPlane}) {
    choose(kAbout, static_cast<int>(shape));
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
  press(kLeft, row(kKeepAndClear));
  const WindowResult kept = run();
  ASSERT_TRUE(kept.view.probe->kept);
  EXPECT_EQ(kept.view.probe->kept->size(), 1U);
  const auto script = options_.script;
  const int last = last_;

  press(kDeleteX, kKeptY);
  EXPECT_TRUE(run().view.probe->kept->empty());

  options_.script = script;
  last_ = last;
  press(kRight, kFileY);
  EXPECT_NE(run().message.find("saved"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder_.path("followed.vtp")));

  options_.script = script;
  last_ = last;
  press(kLeft, kFileY);
  key('A', kModifierControl);
  int frame = next();
  for (const char letter : std::string("ok.csv")) {
    key_down(frame, letter == '.' ? '.' : letter - 'a' + 'A');  // K keeps nothing while text is written
    at(frame, {.kind = InputKind::kText, .key = letter});
    key_up(frame + 1, letter == '.' ? '.' : letter - 'a' + 'A');
    frame += 2;
  }
  press(kRight, kFileY);
  const WindowResult saved = run();
  EXPECT_NE(saved.message.find("ok.csv"), std::string::npos) << saved.message;
  EXPECT_NE(read_file(folder_.path("ok.csv")).find("force"), std::string::npos);
  EXPECT_EQ(saved.view.probe->kept->size(), 1U);
}

TEST_F(TouchPanelTest, OtherLinesOfTheSameFieldLeaveTheProbeInTheHand) {
  constexpr double kTolerance = 680.0;  // among the lines' controls, below the end of a small window
  middle_y_ += 0.5 * (760 - options_.height);
  options_.height = 760;
  grab();
  press(kLeastOf, kTolerance);
  const WindowResult traced = run();
  EXPECT_GT(model_.updated, 0);
  EXPECT_EQ(traced.settings.tolerance, 1e-12);
  EXPECT_TRUE(traced.probe.held);
}

TEST_F(TouchPanelTest, ThePathIsCleared) {
  grab();
  lead_to(80.0, 0.0);
  key('G');
  EXPECT_GT(run().view.probe->path.count, 20U);
  press(kRight, row(kKeepAndClear));
  EXPECT_LT(run().view.probe->path.count, 2U);
}

}  // namespace
}  // namespace palpate::test
