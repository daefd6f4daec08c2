// The curve editor in the window: what the mouse does to its knots reaches the servo while the hand holds on.

#include <variant>

#include "common/hand/mode/haptic_mode.h"
#include "common/hand/mode/linear_mode.h"
#include "tests/common/window/touch_window.h"

namespace palpate::test {
namespace {

/// Parts of the editor: thresholds from 0 to 20 mm upwards, speeds from 0 to the right.
constexpr double kMiddle = 0.5;
constexpr double at_tau(double millimetres) { return 1.0 - millimetres / 20.0; }
constexpr double kPixel = 0.25;  // [mm] of a threshold

class CurvePanelTest : public TouchWindowTest {
 protected:
  void SetUp() override {
    TouchWindowTest::SetUp();
    options_.touch.modes = {find_mode(modes_of(FieldKind::kScalar), kLinearMode)};
    options_.touch.choice.settings.linear =
        linear_settings({.reference = "axes", .axes = "drag,drag,drag", .tau = "4", .measure = "speed"});
    options_.touch.record = folder_.path("run.rec");
    grab();
  }
  /// Events at a part of the editor's width and height.
  void over(int frame, InputEvent event, double across, double down) {
    at_control(frame, std::move(event), "tau", 0, across, down);
  }
  void drag(double from_x, double from_y, double to_x, double to_y) {
    constexpr int kSteps = 6;
    const int begin = next();
    over(begin, {.kind = InputKind::kMove}, from_x, from_y);
    at(begin + 2, {.kind = InputKind::kPress});
    for (int i = 1; i <= kSteps; ++i) {
      over(begin + 2 + i, {.kind = InputKind::kMove}, from_x + (to_x - from_x) * i / kSteps,
           from_y + (to_y - from_y) * i / kSteps);
    }
    at(begin + 4 + kSteps, {.kind = InputKind::kRelease});
  }
  void double_click(double x, double y) {
    const int begin = next();
    over(begin, {.kind = InputKind::kMove}, x, y);
    for (const int frame : {begin + 2, begin + 6}) {
      at(frame, {.kind = InputKind::kPress});
      at(frame + 2, {.kind = InputKind::kRelease});
    }
  }
  void right_click(double x, double y) {
    const int begin = next();
    over(begin, {.kind = InputKind::kMove}, x, y);
    at(begin + 2, {.kind = InputKind::kPress, .button = MouseButton::kRight});
    at(begin + 4, {.kind = InputKind::kRelease, .button = MouseButton::kRight});
  }
  /// The threshold of the first axis that the servo was given last.
  HapticTransferFunction felt() {
    const WindowResult result = run();
    EXPECT_TRUE(result.probe.held) << "the hand holds on";
    HapticTransferFunction last = 0.004;
    const Recording recording = read_recording(options_.touch.record.string());
    EXPECT_EQ(recording.chains.size(), 1U) << "no chain is built anew";
    for (const RecordedChange& change : recording.changes) {
      const auto* settings = std::get_if<ChainSettings>(&change.change);
      if (settings != nullptr) last = settings->linear.axes[0].tau;
    }
    return last;
  }
};

TEST_F(CurvePanelTest, AConstantIsDragged) {
  drag(kMiddle, at_tau(4.0), kMiddle + 0.1, at_tau(12.0));
  const HapticTransferFunction tau = felt();
  EXPECT_TRUE(tau.constant());
  EXPECT_NEAR(1e3 * tau(0.0), 12.0, kPixel);
}

TEST_F(CurvePanelTest, ADoubleClickAddsAKnotThatIsDraggedAndMadeSmooth) {
  double_click(0.75, at_tau(15.0));
  drag(0.75, at_tau(15.0), 0.5, at_tau(10.0));
  press("smooth");
  const HapticTransferFunction tau = felt();
  ASSERT_EQ(tau.knots().size(), 2U);
  const double fastest = helix_flow(0.25)->max_speed();
  EXPECT_EQ(tau.knots()[0], (HapticTransferFunction::Knot{0.0, 0.004})) << "what it was, at the far end";
  EXPECT_NEAR(tau.knots()[1].measure, 0.5 * fastest, 0.02 * fastest);
  EXPECT_NEAR(1e3 * tau.knots()[1].value, 10.0, kPixel);
  EXPECT_TRUE(tau.smooth());
}

TEST_F(CurvePanelTest, ARightClickTakesAKnotOut) {
  double_click(0.75, at_tau(15.0));
  right_click(0.75, at_tau(15.0));
  const HapticTransferFunction tau = felt();
  EXPECT_TRUE(tau.constant());
  EXPECT_EQ(tau(0.0), 0.004);
}

}  // namespace
}  // namespace palpate::test
