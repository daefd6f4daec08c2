// Every control of a panel that edits a setting is pressed: the document has another value of it then, a session
// brings that back, and a window of that session shows the same picture.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <stb_image.h>

#include "apps/cardiac/cardiac_model.h"
#include "apps/cardiac/cardiac_verbs.h"
#include "apps/dtmri/dtmri_model.h"
#include "apps/flow/flow_model.h"
#include "apps/flow/flow_verbs.h"
#include "apps/grid/grid_model.h"
#include "common/cli/command_line.h"
#include "common/cli/window_touch.h"
#include "common/compose/line_view.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/scene/session_of.h"
#include "common/window/panels/panel.h"
#include "common/window/panels/panel_parts.h"
#include "common/window/panels/volume/volume_panel.h"
#include "common/window/window.h"
#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

struct Program {
  std::string name;
  FieldKind kind;
  std::vector<PanelPart> panels;
  std::function<std::unique_ptr<WindowModel>(const Document&)> model;
};

class PanelWalk : public ExplorerTest {
 protected:
  PanelWalk() : ExplorerTest("flow") {}
  void SetUp() override {
    if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
  }

  WindowResult open(const Program& program, const Document& document, const VerbContext& context,
                    std::vector<ScriptedEvent> script, int frames) {
    WindowOptions window{.program = program.name,
                         .width = kWidth,
                         .height = kHeight,
                         .frame_budget = 1e6,
                         .angles = camera_angles(document.view.camera),
                         .focal_point = focal_point_of(document.view),
                         .picture_folder = folder_.path(),
                         .touch = window_touch(modes_of(program.kind), document, context),
                         .panels = program.panels,
                         .script = std::move(script),
                         .frames = frames,
                         .screenshot = folder_.path("window.png"),
                         .hidden = true};
    const std::unique_ptr<WindowModel> model = program.model(document);
    return run_window(*model, window);
  }

  /// Of the last window, without its panel.
  std::vector<unsigned char> picture() {
    int width = 0, height = 0;
    unsigned char* pixels = stbi_load(folder_.path("window.png").c_str(), &width, &height, nullptr, 3);
    if (pixels == nullptr) return {};
    const auto left = static_cast<int>(layout(kWidth, kHeight, kTextHeight).picture.left) + 2;
    std::vector<unsigned char> bytes;
    for (int y = 0; y < height; ++y)
      bytes.insert(bytes.end(), pixels + 3 * (y * width + left), pixels + 3 * (y + 1) * width);
    stbi_image_free(pixels);
    return bytes;
  }

  /// @param arguments of the command line that the window begins with. @return the settings that the panel has shown.
  std::set<std::string> walk(const Program& program, const std::vector<std::string>& arguments) {
    const Explorer explorer{
        .name = program.name,
        .kind = program.kind,
        .verbs = {{.name = "open",
                   .groups = {Group::kInput, Group::kLines, Group::kView, Group::kPanes, Group::kTouch,
                              Group::kLayer, Group::kAngle, Group::kPlot, Group::kNotes, Group::kPart}}}};
    Progress progress;
    InterruptGuard interrupt(progress, program.name);
    Console console(program.name, false, true);
    const VerbContext context{explorer, progress, interrupt, console, program.name};
    std::string words;
    for (const std::string& word : arguments) words += " " + word;
    const Document start = parse_command_line(explorer, arguments).options;
    const WindowResult before = open(program, start, context, {}, 12);
    std::set<std::string> shown;
    for (const DrawnControl& control : drawn_controls()) {
      if (control.setting.empty() || !shown.insert(control.setting).second) continue;
      press(program, before.document, context, control, words);
    }
    return shown;
  }

 private:
  /// The setting of `control` alone is edited.
  void press(const Program& program, const Document& start, const VerbContext& context,
             const DrawnControl& control, const std::string& words) {
    const Setting* const row = find_setting(control.setting, program.kind);
    ASSERT_NE(row, nullptr) << control.setting;
    const std::string name = program.name + words + ": " + control.setting;
    const std::string was = value_text(*row, start);
    WindowResult made;
    // A value may be the one that is there already: another place then.
    for (const double across : {0.83, 0.27}) {
      made = open(program, start, context, events(*row, control, was, across), 60);
      if (value_text(*row, made.document) != was) break;
    }
    EXPECT_TRUE(made.missing.empty()) << name;
    EXPECT_NE(value_text(*row, made.document), was) << name << " is as it was";
    if (!row->saved) return;
    const auto picture_before = picture();
    Document again = start;
    again.given.clear();
    const Session session = session_of(made.document, program.name);
    take_into(again, session, program.kind);
    EXPECT_EQ(value_text(*row, again), value_text(*row, made.document)) << name << " is not in the session";
    (void)open(program, again, context, {}, 12);
    const auto picture_after = picture();
    ASSERT_EQ(picture_before.size(), picture_after.size());
    int worst = 0;
    for (std::size_t i = 0; i < picture_before.size(); ++i)
      worst = std::max(worst, std::abs(picture_before[i] - picture_after[i]));
    EXPECT_LE(worst, 1) << name << " [1/255]";
  }

  static void take_into(Document& document, const Session& session, FieldKind kind) {
    for (const auto& [name, value] : session.options) {
      const Setting* const row = find_setting(name, kind);
      ASSERT_NE(row, nullptr) << name;
      set_value(*row, document, value);
    }
  }

  static std::vector<ScriptedEvent> events(const Setting& row, const DrawnControl& control,
                                           const std::string& was, double across) {
    std::vector<ScriptedEvent> script;
    int frame = 4;
    const auto at = [&](InputKind kind, const std::string& label, double x) {
      script.push_back({.frame = frame += 3, .event = {.kind = kind}, .control = label, .across = x});
    };
    const bool box = std::holds_alternative<ValueAt<bool>>(row.place) ||
                     std::holds_alternative<ValueAt<std::optional<bool>>>(row.place);
    at(InputKind::kMove, control.label, box ? 0.5 : across);
    at(InputKind::kPress, control.label, box ? 0.5 : across);
    at(InputKind::kRelease, control.label, box ? 0.5 : across);
    const std::vector<std::string_view> words = row.word_list();
    const auto other =
        std::find_if(words.begin(), words.end(), [&](std::string_view word) { return word != was; });
    if (!box && other != words.end()) {
      for (const InputKind kind : {InputKind::kMove, InputKind::kPress, InputKind::kRelease})
        at(kind, std::string(*other), 0.5);
    }
    return script;
  }

  static constexpr int kWidth = 620, kHeight = 3000;
  static constexpr float kTextHeight = 14.0F;
};

template <typename Model>
std::function<std::unique_ptr<WindowModel>(const Document&)> model_of(const std::string& name) {
  return [name](const Document& document) { return std::make_unique<Model>(document, name); };
}

TEST_F(PanelWalk, Flow) {
  const Program flow{"flow", FieldKind::kVector, flow_panels(), model_of<FlowModel>("flow")};
  const auto shown = walk(flow, {"--example", "abc", "--seeds", "random:4"});
  for (const std::string& one : shown) std::printf("flow shows %s\n", one.c_str());
}

}  // namespace
}  // namespace palpate::test
