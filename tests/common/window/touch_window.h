/// The probe in a real window, driven by scripted mouse and keys under a (virtual) display.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/compose/view_keep.h"
#include "common/load/series_list.h"
#include "common/scene/document/setting.h"
#include "common/servo/recording.h"
#include "common/trace/trace.h"
#include "common/window/panels/panel.h"
#include "common/window/window.h"
#include "tests/common/hand/sample_modes.h"
#include "tests/common/trace/helix_field.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {

/// Places across a slider, for its least and its greatest value.
inline constexpr double kLeast = 0.04, kMost = 0.96;

inline constexpr int kEscape = 256, kEnter = 257, kF12 = 301, kShift = 340, kControl = 341;

/// What differs from a new document: " name=value" each.
inline std::string settings_text(const Document& document) {
  std::string all;
  for (const Setting& row : settings()) {
    if (!is_default(row, document)) all += " " + std::string(row.name) + "=" + value_text(row, document);
  }
  return all;
}

/// Helices about the z axis, as another flow in each of two fields and three time steps.
class HelixModel final : public WindowModel {
 public:
  SceneState start(Progress&) override {
    Document document;
    document.input.field = "velocity";
    if (!file.empty()) document.input.files = {file};
    return make(document);
  }
  SceneState open(const InputFiles& files, Progress&) override {
    last_opened = files;
    all_opened.push_back(files);
    if (!several.empty() && files.series.empty())
      throw usage_error(series_question(files.files.front().string(), several));
    Document document;
    if (!files.session.empty()) document = of_session;
    document.common.session = files.session;
    return make(document);
  }
  SceneState update(const Document& document, Progress&) override {
    ++updated;
    return make(document);
  }
  void keep(const SceneView& view, Document& document) const override { keep_camera(view, document); }
  void close() override { ++closed; }
  std::string save_session(const Document& document, const std::filesystem::path& to) override {
    saved = document;
    saved_to.push_back(to);
    return "a file";
  }

  std::atomic<int> updated{0};
  std::filesystem::path file;  ///< of the input, beside which sessions are saved
  Document saved, of_session;
  std::vector<std::filesystem::path> saved_to;
  InputFiles last_opened;
  std::vector<InputFiles> all_opened;
  std::vector<ListedSeries> several;  ///< what is opened holds these
  std::atomic<int> closed{0};

 private:
  SceneState make(Document document) {
    auto info = std::make_shared<SceneInfo>();
    info->name = "helices";
    info->files.files = document.input.files;
    info->fields = {"velocity", "another"};
    info->integrators = {"dp54"};
    info->times = {0.0, 1.0, 2.0};
    const double rise = document.input.field == "another" ? 0.5 : 0.25;
    const double wanted = rise + 0.1 * static_cast<double>(time_step_of(document, info->times));
    if (wanted != rise_) flow_ = helix_flow(wanted);
    rise_ = wanted;
    SceneState scene{.probed = flow_};
    info->bounds = scene.probed->bounds();
    scene.info = info;
    document.tracing.integrator = "dp54";
    document.tracing.seeds = "random:12";
    scene.document = std::move(document);
    std::vector<Vec3> seeds;
    for (int i = 0; i < 12; ++i) seeds.push_back({0.3 + 0.12 * i, 0.0, -1.5 + 0.25 * i});
    TraceOptions options{.backward = true, .max_length = 12.0, .threads = 1};
    scene.lines = std::make_shared<const std::vector<Line>>(trace_lines(*scene.probed, seeds, options).lines);
    scene.seeds = seeds.size();
    return scene;
  }

  std::shared_ptr<const VectorField> flow_;  ///< the same object as long as it is the same flow
  double rise_ = -1.0;
};

class TouchWindowTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
    constexpr int kWidth = 800, kHeight = 640;
    options_.width = kWidth;
    options_.height = kHeight;
    options_.touch.modes = sample_modes();
    options_.picture_folder = folder_.path();
    options_.session = folder_.path("helix.palpate.toml");
    if (const char* folder = std::getenv("PALPATE_PICTURES")) {
      std::filesystem::create_directories(folder);
      options_.screenshot =
          std::filesystem::path(folder) /
          (std::string("touch_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".png");
    }
    constexpr float kTextHeight = 14.0F;
    const PictureArea area = layout(kWidth, kHeight, kTextHeight).picture;
    middle_x_ = area.left + 0.5 * area.width;
    middle_y_ = 0.5 * area.height;
    move(1, middle_x_, middle_y_);
  }

  /// For a panel that is longer than most. @param height [px], which a screen need not have
  void grow_to(int height) {
    middle_y_ += 0.5 * (height - options_.height);
    options_.height = height;
    options_.hidden = true;
  }

  // Frames, of kFrame at least: those between two events give the servo time to answer. They are few, since
  // drawing them is what these tests take.
  static constexpr int kPause = 5;
  static constexpr std::chrono::milliseconds kFrame{25};

  /// Runs the script and `kPause` frames more.
  WindowResult run() { return run_model(model_); }
  WindowResult run_model(WindowModel& model) {
    options_.frames = last_ + 2 * kPause;
    options_.patience = 60.0;
    options_.stop_requested = [this, last = std::chrono::steady_clock::now()]() mutable {
      std::this_thread::sleep_until(last + kFrame);
      const auto now = std::chrono::steady_clock::now();
      last = now;
      frame_times_.push_back(std::chrono::duration<double, std::milli>(now.time_since_epoch()).count());
      return false;
    };
    WindowResult result = run_window(model, options_);
    EXPECT_EQ(result.missing, std::vector<std::string>()) << "controls that no panel had";
    return result;
  }
  void at(int frame, InputEvent event) {
    options_.script.push_back({frame, std::move(event)});
    last_ = std::max(last_, frame);
  }
  void move(int frame, double x, double y) { at(frame, {.kind = InputKind::kMove, .x = x, .y = y}); }
  /// From the middle of the picture.
  void move_by(int frame, double dx, double dy) { move(frame, middle_x_ + dx, middle_y_ + dy); }
  void key_down(int frame, int code, int modifiers = 0) {
    at(frame, {.kind = InputKind::kKeyDown, .key = code, .modifiers = modifiers});
  }
  void key_up(int frame, int code) { at(frame, {.kind = InputKind::kKeyUp, .key = code}); }
  void click(int frame, double x, double y) {
    move(frame, x, y);
    at(frame + 1, {.kind = InputKind::kPress});
    at(frame + 3, {.kind = InputKind::kRelease});
  }
  /// A click on a control of the panel, by its label: wherever that is drawn then.
  void press(const std::string& control, int which = 0, double across = 0.5) {
    at_control(next(), {.kind = InputKind::kPress}, control, which, across);
    at(last_ + 2, {.kind = InputKind::kRelease});
  }
  /// Of a list, by the words in it.
  void choose(const std::string& list, const std::string& words) {
    press(list);
    press(words);
  }
  void at_control(int frame, InputEvent event, const std::string& control, int which = 0, double across = 0.5,
                  double down = 0.5) {
    options_.script.push_back({frame, std::move(event), control, which, across, down});
    last_ = std::max(last_, frame);
  }
  /// Grabs the probe at the middle of the picture; at rest it is held by the line there.
  void grab() {
    move_by(next(), 0.0, 0.0);
    key('G');
    last_ += kPause;
  }
  /// Moves the mouse a few pixels a frame, so that the hand is held on its way.
  void lead_to(double dx, double dy) {
    constexpr int kSteps = 20;
    const int begin = next();
    for (int i = 1; i <= kSteps; ++i) {
      move_by(begin + i, from_x_ + (dx - from_x_) * i / kSteps, from_y_ + (dy - from_y_) * i / kSteps);
    }
    from_x_ = dx;
    from_y_ = dy;
  }
  /// After what was scripted so far, with time for it.
  [[nodiscard]] int next() const { return last_ + kPause; }
  void key(int code, int modifiers = 0) {
    const int frame = next();
    key_down(frame, code, modifiers);
    key_up(frame + 1, code);
  }

  /// Into the field that has the keyboard, a letter a frame.
  void type(const std::string& words) {
    int frame = next();
    for (const char letter : words) at(frame++, {.kind = InputKind::kText, .key = letter});
  }

  TempFolder folder_;
  HelixModel model_;
  WindowOptions options_;
  double middle_x_ = 0.0, middle_y_ = 0.0;
  int last_ = 0;
  double from_x_ = 0.0, from_y_ = 0.0;  ///< of lead_to()
  std::vector<double> frame_times_;     ///< [ms]
};

}  // namespace palpate::test
