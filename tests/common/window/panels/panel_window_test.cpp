// The panel in a window: search over settings, folded parts, defaults, help, messages.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/window/panels/panel_parts.h"
#include "common/window/panels/seed_panel.h"
#include "common/window/panels/setting_search.h"
#include "tests/common/window/touch_window.h"

namespace palpate::test {
namespace {

constexpr int kTab = 258, kF2 = 291;

class PanelWindow : public TouchWindowTest {
 protected:
  void SetUp() override {
    TouchWindowTest::SetUp();
    if (IsSkipped()) return;
    grow_to(1000);
    options_.panels = {[](PanelContext& on) {
      if (!section("LINES")) return;
      edit_setting("tract-opacity", opacity);
      draw_seeds(on.state, true);
    }};
    opacity = 0.25;
  }
  void again() {
    options_.script.clear();
    last_ = 0;
  }

  /// Runs the script, which names a control that is not there: nothing waits for it.
  std::vector<std::string> missing() {
    options_.frames = last_ + 2 * kPause;
    options_.patience = 0.0;
    return run_window(model_, options_).missing;
  }

  static double opacity;
};
double PanelWindow::opacity = 0.25;

TEST_F(PanelWindow, SearchGoesToAControlAndGivesItTheKeyboard) {
  key('/');
  type("stiffness");
  key(kEnter);
  last_ += kPause;
  type("123");
  key(kEnter);
  EXPECT_EQ(run().document.touch.stiffness, 123.0);
}

TEST_F(PanelWindow, SearchUnfoldsThePartInWhichTheControlIs) {
  at_control(next(), {.kind = InputKind::kMove}, "stiffness");
  EXPECT_EQ(missing(), std::vector<std::string>{"stiffness"});
  again();
  key('P', kModifierControl);
  type("stiff");
  key(kEnter);
  last_ += kPause;
  type("77");
  key(kEnter);
  EXPECT_EQ(run().document.touch.stiffness, 77.0);
}

TEST_F(PanelWindow, ForcesAreFoldedUntilAProbeIsGrabbedAndAsTheyWereClickedAfterThat) {
  grab();
  at_control(next(), {.kind = InputKind::kMove}, "stiffness");
  (void)run();
  again();
  grab();
  press("FORCES");
  at_control(next(), {.kind = InputKind::kMove}, "stiffness");
  EXPECT_EQ(missing(), std::vector<std::string>{"stiffness"});
}

TEST_F(PanelWindow, SearchSaysWhereASettingWithoutAControlIs) {
  key('/');
  type("max-steps");
  key(kEnter);
  EXPECT_NE(run().message.find("--max-steps"), std::string::npos);
}

TEST(FindSettings, EachWordIsLookedForAndLabelsComeFirst) {
  const auto found = find_settings("range", FieldKind::kVector);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front()->name, "range");
  EXPECT_GT(found.size(), 1U) << "in helps, too";
  const auto all = find_settings("", FieldKind::kVector);
  EXPECT_TRUE(
      std::ranges::all_of(all, [](const Setting* row) { return row->kinds.has(FieldKind::kVector); }));
  EXPECT_TRUE(find_settings("range nosuchword", FieldKind::kVector).empty());
}

TEST_F(PanelWindow, ARightClickOffersTheDefault) {
  at_control(next(), {.kind = InputKind::kPress, .button = MouseButton::kRight}, "tract opacity");
  at(last_ + 2, {.kind = InputKind::kRelease, .button = MouseButton::kRight});
  press("Reset to default");
  (void)run();
  EXPECT_EQ(opacity, 1.0);
}

TEST_F(PanelWindow, EscapeClosesTheOfferOfADefault) {
  at_control(next(), {.kind = InputKind::kPress, .button = MouseButton::kRight}, "tract opacity");
  at(last_ + 2, {.kind = InputKind::kRelease, .button = MouseButton::kRight});
  key(kEscape);
  at_control(next(), {.kind = InputKind::kMove}, "Reset to default");
  EXPECT_EQ(missing(), std::vector<std::string>{"Reset to default"});
  EXPECT_EQ(opacity, 0.25);
}

TEST_F(PanelWindow, TheDefaultOfADrawnPictureComesBack) {
  options_.view.background = Background::kLight;
  press("TOUCH");  // folded, or what is below would be out of sight
  at_control(next(), {.kind = InputKind::kPress, .button = MouseButton::kRight}, "background");
  at(last_ + 2, {.kind = InputKind::kRelease, .button = MouseButton::kRight});
  press("Reset to default");
  EXPECT_EQ(run().view.background, Background::kDark);
}

TEST_F(PanelWindow, TabHidesThePanelAndThePictureTakesItsPlace) {
  key(kTab);
  at_control(next(), {.kind = InputKind::kMove}, "tract opacity");
  EXPECT_EQ(missing(), std::vector<std::string>{"tract opacity"});
  again();
  key(kTab);
  key(kTab);
  at_control(next(), {.kind = InputKind::kMove}, "tract opacity");
  (void)run();
}

TEST_F(PanelWindow, AllMessagesAreInTheLog) {
  key('J');  // means nothing
  key('V');
  key(kF2);
  press("Copy all");
  const std::string log = run().log;
  EXPECT_NE(log.find("J does nothing"), std::string::npos) << log;
  EXPECT_NE(log.find("there is no volume here"), std::string::npos) << log;
  EXPECT_LT(log.find("J does nothing"), log.find("there is no volume here")) << "the oldest first";
}

}  // namespace
}  // namespace palpate::test
