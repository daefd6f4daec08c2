/// dtmri's window, led by a script as a user leads it with mouse and keys.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "apps/dtmri/dtmri_model.h"
#include "apps/dtmri/dtmri_verbs.h"
#include "common/cli/command_line.h"
#include "common/cli/window_touch.h"
#include "common/compose/line_view.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/window/panels/panel.h"
#include "common/window/window.h"
#include "tests/e2e/explorer_test.h"

namespace palpate::test {

class DtmriWindow : public ExplorerTest {
 protected:
  DtmriWindow() : ExplorerTest("dtmri") {}

  /// Runs the script so far, which begins anew. @param picture of the window's last frame; empty: in the folder.
  WindowResult open(const std::vector<std::string>& arguments, const std::filesystem::path& picture = {}) {
    const ParsedCommand parsed = parse_command_line(explorer_, arguments);
    const QuietVerb verb(explorer_);
    WindowOptions window{.program = "dtmri",
                         .width = width_,
                         .height = height_,
                         .angles = camera_angles(parsed.options.view.camera),
                         .session = folder_.path("a.palpate.toml"),
                         .picture_folder = folder_.path(),
                         .touch = window_touch(modes_of(FieldKind::kTensor), parsed.options, verb.context),
                         .panels = dtmri_panels(),
                         .script = std::exchange(script_, {}),
                         .hidden = true};  // a screen is lower than the panel
    window.frames = std::exchange(next_, kFirst) + 30;
    window.patience = 60.0;
    window.screenshot = picture.empty() ? std::filesystem::path(folder_.path("window.png")) : picture;
    DtmriModel model(parsed.options, "dtmri");
    WindowResult result = run_window(model, window);
    EXPECT_EQ(result.missing, std::vector<std::string>()) << "controls that no panel had";
    if (const char* folder = std::getenv("PALPATE_PICTURES"))
      std::filesystem::copy(window.screenshot,
                            std::filesystem::path(folder) / (std::string("dtmri_") + name() + ".png"),
                            std::filesystem::copy_options::overwrite_existing);
    return result;
  }
  static std::string name() { return ::testing::UnitTest::GetInstance()->current_test_info()->name(); }

  void at(InputEvent event, const std::string& control = {}, double across = 0.5, int which = 0) {
    script_.push_back({.frame = next_ += 3,
                       .event = std::move(event),
                       .control = control,
                       .which = which,
                       .across = across});
  }
  /// @param across where in the control, from its left to its right. @param which of several of that label.
  void press(const std::string& control, double across = 0.5, int which = 0) {
    at({.kind = InputKind::kMove}, control, across, which);
    at({.kind = InputKind::kPress});
    at({.kind = InputKind::kRelease});
    next_ += 6;
  }
  void choose(const std::string& list, const std::string& word) {
    press(list);
    press(word);
  }
  void click(double x, double y) {
    at({.kind = InputKind::kMove, .x = x, .y = y});
    at({.kind = InputKind::kPress, .x = x, .y = y});
    at({.kind = InputKind::kRelease, .x = x, .y = y});
    next_ += 6;
  }
  void key(int key, int modifiers = 0) {
    at({.kind = InputKind::kKeyDown, .key = key, .modifiers = modifiers});
    at({.kind = InputKind::kKeyUp, .key = key, .modifiers = modifiers});
    next_ += 4;
  }
  std::string session() {
    std::ifstream in(folder_.path("a.palpate.toml"));
    return {std::istreambuf_iterator<char>(in), {}};
  }

  static constexpr int kFirst = 90;
  int width_ = 1000, height_ = 900;
  const Explorer explorer_{.name = "dtmri", .kind = FieldKind::kTensor, .verbs = {open_tensors_verb({})}};
  std::vector<ScriptedEvent> script_;
  int next_ = kFirst;
};

}  // namespace palpate::test
