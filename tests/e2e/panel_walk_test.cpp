// Every control of a panel that edits a setting is pressed: the document has another value of it then, a session
// brings that back, and a window of that session shows the same picture.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <map>
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
    const std::vector<DrawnControl> controls = drawn_controls();
    for (const DrawnControl& control : controls) {
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
    for (int attempt = 0; attempt < 2; ++attempt) {
      made = open(program, start, context, events(*row, control, was, attempt), 60);
      if (value_text(*row, made.document) != was) break;
    }
    EXPECT_TRUE(made.missing.empty()) << name;
    EXPECT_NE(value_text(*row, made.document), was) << name << " is as it was";
    if (!row->saved) return;
    const auto picture_before = picture();
    if (const char* folder = std::getenv("PALPATE_PICTURES"))
      std::filesystem::copy(folder_.path("window.png"),
                            std::filesystem::path(folder) / (control.setting + "_made.png"),
                            std::filesystem::copy_options::overwrite_existing);
    Document again = start;
    again.given.clear();
    const Session session = session_of(made.document, program.name);
    take_into(again, session, program.kind);
    EXPECT_EQ(value_text(*row, again), value_text(*row, made.document)) << name << " is not in the session";
    (void)open(program, again, context, {}, 60);
    const auto picture_after = picture();
    if (const char* folder = std::getenv("PALPATE_PICTURES"))
      std::filesystem::copy(folder_.path("window.png"),
                            std::filesystem::path(folder) / (control.setting + "_again.png"),
                            std::filesystem::copy_options::overwrite_existing);
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

  /// Lists whose entries are other words than those of the setting, and what is typed into fields.
  static std::vector<std::string> entries_of(const Setting& row, const std::string& was) {
    static const std::map<std::string, std::vector<std::string>> kEntries{
        {"integrator", {"rk4", "bs32"}}, {"color", {"time", "length"}}, {"background", {"light"}}};
    if (const auto found = kEntries.find(std::string(row.name)); found != kEntries.end())
      return found->second;
    std::vector<std::string> entries;
    for (const std::string_view word : row.word_list()) {
      if (word != was) entries.emplace_back(word);
    }
    return entries;
  }

  static std::vector<ScriptedEvent> events(const Setting& row, const DrawnControl& control,
                                           const std::string& was, int attempt) {
    std::vector<ScriptedEvent> script;
    int frame = 4;
    const auto click = [&](const std::string& label, double across) {
      for (const InputKind kind : {InputKind::kMove, InputKind::kPress, InputKind::kRelease})
        script.push_back({.frame = frame += 3, .event = {.kind = kind}, .control = label, .across = across});
    };
    const bool box = std::holds_alternative<ValueAt<bool>>(row.place) ||
                     std::holds_alternative<ValueAt<std::optional<bool>>>(row.place);
    click(control.label, box ? 0.5 : attempt == 0 ? 0.83 : 0.27);
    const std::vector<std::string> entries = entries_of(row, was);
    if (!box && !entries.empty()) click(attempt == 0 ? entries.front() : entries.back(), 0.5);
    return script;
  }

  static constexpr int kWidth = 620, kHeight = 3000;
  static constexpr float kTextHeight = 14.0F;
};

template <typename Model>
std::function<std::unique_ptr<WindowModel>(const Document&)> model_of(const std::string& name) {
  return [name](const Document& document) { return std::make_unique<Model>(document, name); };
}

/// Sets that together are all settings that the panel has shown.
TEST_F(PanelWalk, Flow) {
  const Program flow{"flow", FieldKind::kVector, flow_panels(), model_of<FlowModel>("flow")};
  const auto shown = walk(flow, {"--example", "abc", "--seeds", "random:4"});
  for (const std::string& one : shown) std::printf("flow shows %s\n", one.c_str());
}

TEST_F(PanelWalk, Grid) {
  const Program grid{"grid", FieldKind::kScalar, {draw_volume}, model_of<GridModel>("grid")};
  const auto shown = walk(grid, {"--example", "marschner-lobb", "--layout", "4", "--slab", "0.1"});
  for (const std::string& one : shown) std::printf("grid shows %s\n", one.c_str());
}

TEST_F(PanelWalk, Dtmri) {
  const Program dtmri{"dtmri", FieldKind::kTensor, dtmri_panels(), model_of<DtmriModel>("dtmri")};
  const auto shown = walk(dtmri, {"--example", "helix", "--seeds", "point:20,0,0"});
  for (const std::string& one : shown) std::printf("dtmri shows %s\n", one.c_str());
}

TEST_F(PanelWalk, Cardiac) {
  const Program cardiac{"cardiac", FieldKind::kFibre, cardiac_panels(), model_of<CardiacModel>("cardiac")};
  const auto shown = walk(cardiac, {"--example", "ventricle", "--seeds", "random:4"});
  for (const std::string& one : shown) std::printf("cardiac shows %s\n", one.c_str());
}

}  // namespace
}  // namespace palpate::test
