// Every control of a panel that edits a setting is pressed: the document has another value of it then, a session
// brings that back, and a window of that session shows the same picture.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <ranges>
#include <regex>
#include <set>
#include <span>
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
#include "common/compose/appearance.h"
#include "common/compose/line_view.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/scene/session.h"
#include "common/window/panels/panel.h"
#include "common/window/panels/panel_parts.h"
#include "common/window/panels/volume/volume_panel.h"
#include "common/window/window.h"
#include "tests/e2e/explorer_test.h"
#include "tests/support/project_folders.h"

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
                    std::vector<ScriptedEvent> script, int frames, double patience = 60.0) {
    SceneView view;
    apply_appearance(document, view);
    // Away from all controls, whose hints may reach into the picture.
    script.push_back(
        {.frame = frames - 6, .event = {.kind = InputKind::kMove, .x = 20.0, .y = kHeight - 50.0}});
    WindowOptions window{.program = program.name,
                         .width = kWidth,
                         .height = kHeight,
                         .view = std::move(view),
                         .frame_budget = 1e6,
                         .angles = camera_angles(document.view.camera),
                         .focal_point = focal_point_of(document.view),
                         .picture_folder = folder_.path(),
                         .touch = window_touch(modes_of(program.kind), document, context),
                         .panels = program.panels,
                         .plotted = document.series.plot,
                         .play_rate = document.view.play_rate,
                         .script = std::move(script),
                         .frames = frames,
                         .patience = patience,
                         .screenshot = folder_.path("window.png"),
                         .hidden = true};
    const std::unique_ptr<WindowModel> model = program.model(document);
    return run_window(*model, window);
  }

  /// Of the last window, without its panel. @param name of the copy that PALPATE_PICTURES gets.
  std::vector<unsigned char> picture(const std::string& name) {
    if (const char* folder = std::getenv("PALPATE_PICTURES"))
      std::filesystem::copy(folder_.path("window.png"), std::filesystem::path(folder) / (name + ".png"),
                            std::filesystem::copy_options::overwrite_existing);
    int width = 0, height = 0;
    unsigned char* pixels = stbi_load(folder_.path("window.png").c_str(), &width, &height, nullptr, 3);
    if (pixels == nullptr) return {};
    const auto left = static_cast<int>(layout(kWidth, kHeight, kTextHeight).picture.left) + 2;
    std::vector<unsigned char> bytes;
    constexpr int kWords = 400;  // times, banners and notes at the lower end
    for (int y = 0; y < height - kWords; ++y)
      bytes.insert(bytes.end(), pixels + 3 * (y * width + left), pixels + 3 * (y + 1) * width);
    stbi_image_free(pixels);
    return bytes;
  }

  /// Presses what no walk before has. @param arguments of the command line that the window begins with.
  void walk(const Program& program, const std::vector<std::string>& source,
            std::vector<std::string> arguments) {
    const Explorer explorer{
        .name = program.name,
        .kind = program.kind,
        .verbs = {{.name = "open",
                   .groups = {Group::kInput, Group::kLines, Group::kView, Group::kPanes, Group::kTouch,
                              Group::kLayer, Group::kAngle, Group::kPlot, Group::kNotes, Group::kPart}}}};
    const QuietVerb verb(explorer);
    std::string words;
    for (const std::string& word : arguments) words += " " + word;
    std::vector<std::string> line{"open"};
    line.insert(line.end(), source.begin(), source.end());
    const Document plain = parse_command_line(explorer, line).options;
    line.insert(line.end(), arguments.begin(), arguments.end());
    const Document start = parse_command_line(explorer, line).options;
    const WindowResult before = open(program, start, verb.context, {}, 12);
    std::vector<DrawnControl> together;
    const auto press_all = [&] {
      press(program, plain, before.document, verb.context, std::exchange(together, {}), words);
    };
    // From below: what a control hides or shows lies below it.
    const std::vector<DrawnControl> controls = drawn_controls();
    for (const DrawnControl& control : std::views::reverse(controls)) {
      if (control.setting.empty() || !pressed_by_a_click(setting(control.setting)) ||
          !walked_.insert({program.name, control.setting}).second)
        continue;
      together.push_back(control);
      if (together.size() == kTogether) press_all();
    }
    press_all();
  }

  /// A turn that grows from step to step; the path of its list.
  std::string moving_flow() const {
    std::string list = "<VTKFile type=\"Collection\"><Collection>";
    for (int step = 0; step < 3; ++step) {
      std::string text =
          "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 3 3\nORIGIN -1 -1 -1\n"
          "SPACING 1 1 1\nPOINT_DATA 27\nVECTORS v double\n";
      for (int p = 0; p < 27; ++p)
        text += std::to_string(-(step + 1) * (p / 3 % 3 - 1)) + " " +
                std::to_string((step + 1) * (p % 3 - 1)) + " 0\n";
      const std::string name = "t" + std::to_string(step) + ".vtk";
      folder_.write(name, text);
      list += "<DataSet timestep=\"" + std::to_string(step) + "\" file=\"" + name + "\"/>";
    }
    return folder_.write("turn.pvd", list + "</Collection></VTKFile>").string();
  }

  /// A ramp with a place in a patient.
  std::string patient_image(const std::string& name) const {
    std::string text =
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nencoding: raw\nspace: right-anterior-superior\n"
        "space directions: (2,0,0) (0,2,0) (0,0,2)\nspace origin: (-8,-8,-8)\n\n";
    for (int v = 0; v < 512; ++v) text += static_cast<char>(25 * (v % 8) + v / 64);
    return folder_.write(name, text).string();
  }

  /// Every setting that the sources of these panels name was walked.
  void expect_whole(const std::vector<std::string>& folders) const {
    const std::regex naming("(edit_setting|explain|edit_word)\\(\"([a-z-]+)\"");
    std::set<std::string> seen;
    for (const auto& [program, setting] : walked_) seen.insert(setting);
    for (const std::string& folder : folders) {
      for (const auto& file : std::filesystem::recursive_directory_iterator(source_folder() / folder)) {
        if (file.path().extension() != ".cpp") continue;
        const std::string text = read_file(file.path());
        for (std::sregex_iterator at(text.begin(), text.end(), naming), end; at != end; ++at)
          EXPECT_TRUE(seen.contains((*at)[2]) || !pressed_by_a_click(setting((*at)[2].str())))
              << file.path() << " names " << (*at)[2] << ", which no walk saw";
      }
    }
  }

 private:
  /// Edits the settings of all these controls in one window; where something is wrong, of one half after the other, since
  /// one may hide another.
  void press(const Program& program, const Document& plain, const Document& start, const VerbContext& context,
             std::span<const DrawnControl> controls, const std::string& words) {
    if (controls.empty()) return;
    const std::string fault = fault_of(program, plain, start, context, controls);
    if (fault.empty()) return;
    if (controls.size() > 1) {
      press(program, plain, start, context, controls.first(controls.size() / 2), words);
      press(program, plain, start, context, controls.subspan(controls.size() / 2), words);
    } else {
      ADD_FAILURE() << program.name << words << ": " << controls[0].setting << ": " << fault;
    }
  }

  /// What is wrong after the settings of these controls were edited; empty: nothing.
  std::string fault_of(const Program& program, const Document& plain, const Document& start,
                       const VerbContext& context, std::span<const DrawnControl> controls) {
    std::vector<const Setting*> rows;
    for (const DrawnControl& control : controls) {
      rows.push_back(find_setting(control.setting, program.kind));
      if (rows.back() == nullptr) return control.setting + " is no setting";
    }
    const auto is_edited = [&](const Document& made) {
      return std::ranges::none_of(
          rows, [&](const Setting* row) { return value_text(*row, made) == value_text(*row, start); });
    };
    WindowResult made;
    std::vector<ScriptedEvent> script;
    // A value may be the one that is there already: another place then.
    const bool alone = controls.size() == 1;
    bool edited = false;
    for (int attempt = 0; attempt < (alone ? 2 : 1) && !edited; ++attempt) {
      script.clear();
      for (std::size_t i = 0; i < controls.size(); ++i)
        add_events(*rows[i], controls[i], value_text(*rows[i], start), attempt, script);
      made = open(program, start, context, script, script.back().frame + kSettled, alone ? 60.0 : 3.0);
      edited = is_edited(made.document);
    }
    if (!made.missing.empty()) return "no control " + made.missing.front();
    if (!edited) return "as it was";
    if (std::ranges::none_of(rows, &Setting::saved)) return {};
    Document again = plain;
    const std::filesystem::path file = folder_.path("walk.palpate.toml");
    (void)program.model(start)->save_session(made.document, file);
    take_into(again, load_session(file), program.kind);
    for (const Setting* row : rows) {
      if (row->saved && value_text(*row, again) != value_text(*row, made.document))
        return "not in the session";
    }
    const std::string& name = controls.front().setting;
    const auto first = picture(name + "_made");
    int worst = difference(first, picture_of(program, again, context, {}, kSettled, name + "_again"));
    if (worst > 1 && alone) {
      // What hands make besides, surfaces say, takes a busy machine more frames.
      constexpr int kMore = 200;
      worst = difference(picture_of(program, start, context, script, kMore, name + "_made"),
                         picture_of(program, again, context, {}, kMore, name + "_again"));
    }
    return worst <= 1 ? std::string() : "another picture: " + std::to_string(worst) + " of 255";
  }

  /// What a window shows at its end.
  std::vector<unsigned char> picture_of(const Program& program, const Document& document,
                                        const VerbContext& context, std::vector<ScriptedEvent> script,
                                        int frames, const std::string& name) {
    (void)open(program, document, context, std::move(script), frames);
    return picture(name);
  }

  static int difference(const std::vector<unsigned char>& a, const std::vector<unsigned char>& b) {
    if (a.empty() || a.size() != b.size()) return 255;
    int worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
    return worst;
  }

  static void take_into(Document& document, const Session& session, FieldKind kind) {
    for (const auto& [name, value] : session.options) {
      const Setting* const row = find_setting(name, kind);
      ASSERT_NE(row, nullptr) << name;
      set_value(*row, document, value);
    }
  }

  /// What a click into its control changes: not lists of what the data have (fields, modes, seeds), nor what is
  /// drawn (colours of values), nor two whose lists say other words, nor what needs
  /// tensors that were fitted.
  static bool pressed_by_a_click(const Setting& row) {
    static const std::set<std::string_view> kOthers{"stroke", "voxels", "max-cone"},
        kTexts{"integrator",      "color", "background", "angle", "cross",
               "contour-spacing", "range", "resample",   "layer"};
    if (kOthers.contains(row.name)) return false;
    return kTexts.contains(row.name) || !row.words.empty() ||
           !(std::holds_alternative<ValueAt<std::string>>(row.place) ||
             std::holds_alternative<ValueAt<std::vector<std::string>>>(row.place) ||
             std::holds_alternative<ValueAt<std::filesystem::path>>(row.place));
  }

  /// Lists whose entries are other words than those of the setting, and what is typed into fields.
  static std::vector<std::string> entries_of(const Setting& row, const std::string& was) {
    static const std::map<std::string, std::vector<std::string>> kEntries{{"integrator", {"rk4", "bs32"}},
                                                                          {"color", {"time", "length"}},
                                                                          {"background", {"light"}},
                                                                          {"angle", {"transverse"}}};
    if (const auto found = kEntries.find(std::string(row.name)); found != kEntries.end())
      return found->second;
    std::vector<std::string> entries;
    for (const std::string_view word : row.word_list()) {
      if (word != was) entries.emplace_back(word);
    }
    return entries;
  }

  static void add_events(const Setting& row, const DrawnControl& control, const std::string& was, int attempt,
                         std::vector<ScriptedEvent>& script) {
    int frame = script.empty() ? 4 : script.back().frame;
    const auto click = [&](const std::string& label, double across) {
      for (const InputKind kind : {InputKind::kMove, InputKind::kPress, InputKind::kRelease})
        script.push_back({.frame = frame += 3, .event = {.kind = kind}, .control = label, .across = across});
    };
    const bool box = std::holds_alternative<ValueAt<bool>>(row.place) ||
                     std::holds_alternative<ValueAt<std::optional<bool>>>(row.place) ||
                     row.name == "grid-switch";
    click(control.label, box ? 0.5 : attempt == 0 ? 0.83 : 0.27);
    static const std::map<std::string, std::string> kTyped{
        {"cross", "0.25"}, {"contour-spacing", "5"}, {"range", "1.5"}, {"resample", "24"}};
    if (const auto typed = kTyped.find(std::string(row.name)); typed != kTyped.end()) {
      // Twice: a double click takes the whole of the field.
      click(control.label, 0.1);
      script.push_back(
          {.frame = frame, .event = {.kind = InputKind::kPress}, .control = control.label, .across = 0.1});
      script.push_back({.frame = frame += 1,
                        .event = {.kind = InputKind::kRelease},
                        .control = control.label,
                        .across = 0.1});
      for (const char letter : typed->second)
        script.push_back({.frame = frame += 2, .event = {.kind = InputKind::kText, .key = letter}});
      for (const InputKind kind : {InputKind::kKeyDown, InputKind::kKeyUp})
        script.push_back({.frame = frame += 2, .event = {.kind = kind, .key = kEnter}});
      return;
    }
    const std::vector<std::string> entries = entries_of(row, was);
    if (!box && !entries.empty()) click(attempt == 0 ? entries.front() : entries.back(), 0.5);
  }

  inline static std::set<std::pair<std::string, std::string>> walked_;  // by the programs of all walks
  static constexpr std::size_t kTogether = 6;  // controls that a window is opened for
  static constexpr int kSettled = 12;  // frames after which most windows show what they were told last
  static constexpr int kEnter = 257;   // GLFW's
  // No larger than a picture and lists need: its pixels cost the time of this test.
  static constexpr int kWidth = 480, kHeight = 900;
  static constexpr float kTextHeight = 14.0F;
};

template <typename Model>
std::function<std::unique_ptr<WindowModel>(const Document&)> model_of(const std::string& name) {
  return [name](const Document& document) { return std::make_unique<Model>(document, name); };
}

TEST_F(PanelWalk, EveryControlOfFlowIsInTheSessionAndThePictureAgain) {
  const Program flow{"flow", FieldKind::kVector, flow_panels(), model_of<FlowModel>("flow")};
  const std::vector<std::string> abc{"--example", "abc"};
  walk(flow, abc, {"--seeds", "random:4", "--ticks", "auto"});
  for (const HapticMode& mode : modes_of(FieldKind::kVector))
    walk(flow, abc,
         {"--seeds", "random:4", "--stiffness", "300", "--mode", mode.name, "--volume", "speed", "--resample",
          "16"});
  walk(flow, abc, {"--seeds", "random:4", "--integrator", "rk4", "--range", "0,2"});
  walk(flow, abc, {"--fixture", "plane:0,0,1,3", "--carry", "5", "--event-force", "0.2"});
  walk(flow, {moving_flow()}, {"--seeds", "point:0.5,0,0", "--lines", "pathlines"});
}

TEST_F(PanelWalk, EveryControlOfGridIsInTheSessionAndThePictureAgain) {
  const Program grid{"grid", FieldKind::kScalar, {draw_volume}, model_of<GridModel>("grid")};
  const std::vector<std::string> lobb{"--example", "marschner-lobb"};
  walk(grid, lobb, {"--layout", "4", "--slab", "0.1"});
  walk(grid, lobb, {"--layout", "2"});
  for (const HapticMode& mode : modes_of(FieldKind::kScalar))
    walk(grid, lobb, {"--stiffness", "300", "--mode", mode.name});
  walk(grid, lobb, {"--lens", "sphere:0,0,0,0.5"});
  walk(grid, {patient_image("a.nrrd")}, {"--layout", "4", "--field", "scalars," + patient_image("b.nrrd")});
}

TEST_F(PanelWalk, EveryControlOfDtmriIsInTheSessionAndThePictureAgain) {
  const Program dtmri{"dtmri", FieldKind::kTensor, dtmri_panels(), model_of<DtmriModel>("dtmri")};
  const std::vector<std::string> helix{"--example", "helix"};
  walk(dtmri, helix,
       {"--seeds", "point:20,0,0", "--glyphs", "ellipsoid", "--underlay", patient_image("t1.nrrd")});
  walk(dtmri, helix, {"--seeds", "point:20,0,0", "--layout", "4", "--flip", "k"});
  walk(dtmri, helix, {"--bundle", "name=a|color=fa|seeds=point:20,0,0|trace="});
  for (const HapticMode& mode : modes_of(FieldKind::kTensor))
    walk(dtmri, helix, {"--stiffness", "300", "--mode", mode.name});
}

TEST_F(PanelWalk, EveryControlOfCardiacIsInTheSessionAndThePictureAgain) {
  const Program cardiac{"cardiac", FieldKind::kFibre, cardiac_panels(), model_of<CardiacModel>("cardiac")};
  const std::vector<std::string> ventricle{"--example", "ventricle"};
  walk(cardiac, ventricle, {"--seeds", "random:4"});
  walk(cardiac, ventricle, {"--seeds", "random:4", "--cut", "1,0,0,0"});
  for (const HapticMode& mode : modes_of(FieldKind::kFibre))
    walk(cardiac, ventricle, {"--seeds", "random:4", "--stiffness", "300", "--mode", mode.name});
}

// After the walks above, in the same run.
TEST_F(PanelWalk, NoSourceNamesASettingThatNoWalkSaw) { expect_whole({"common/window", "apps"}); }

}  // namespace
}  // namespace palpate::test
