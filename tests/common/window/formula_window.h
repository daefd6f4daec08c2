/// A window over lines by formula.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
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
#include "common/window/window.h"
#include "tests/common/render/sample_scenes.h"

namespace palpate::test {

/// Lines by formula; files named "bad…" cannot be opened.
class FormulaModel : public WindowModel {
 public:
  SceneState start(Progress&) override {
    Document document;
    document.view.color = first_array.empty() ? "speed" : first_array;
    return scene_of("whirlwind", document);
  }
  SceneState open(const InputFiles& input, Progress&) override {
    const auto& files = input.files;
    ++opened;
    last_opened = input;
    if (files.front().string().starts_with("bad")) {
      throw input_error({.file = files.front().string(), .found = "not a data file"});
    }
    return scene_of(files.front().string(), {});
  }
  SceneState update(const Document& document, Progress& progress) override {
    ++updated;
    if (document.input.time == refused) throw work_error("there is no such time");
    for (int i = 0; updated == 1 && i < rests; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      progress.check();
    }
    return scene_of("whirlwind", document);
  }
  void keep(const SceneView& view, Document& document) const override {
    keep_camera(view, document);
    keep_appearance(view, document);
  }
  void close() override {}
  std::string save_session(const Document&, const std::filesystem::path&) override {
    ++saved;
    return "whirlwind.toml";
  }

  std::atomic<int> opened{0}, updated{0}, saved{0};
  InputFiles last_opened;
  std::string first_array;
  std::string refused = "none";  ///< the time of a step that cannot be read
  int rests = 0;                 ///< of 10 ms, in the first update
  bool hurries = false;          ///< the flow is faster the later it is
  bool one_time = false;         ///< there are no others
  std::vector<std::filesystem::path> files_of_scene;
  std::vector<std::string> notes;

 private:
  SceneState scene_of(const std::string& name, const Document& document) const {
    SceneState scene = make(name, document);
    scene.notes.insert(scene.notes.end(), notes.begin(), notes.end());
    if (!files_of_scene.empty()) {
      auto info = std::make_shared<SceneInfo>(*scene.info);
      info->files.files = files_of_scene;
      scene.info = info;
    }
    if (one_time) {
      auto info = std::make_shared<SceneInfo>(*scene.info);
      info->times.clear();
      scene.info = info;
    }
    if (!hurries) return scene;
    std::vector<Line> lines = *scene.lines;
    const double factor = 1.0 + static_cast<double>(time_step_of(document, scene.info->times));
    for (Line& line : lines) {
      for (LinePoint& point : line.points) point.speed *= factor;
    }
    scene.lines = std::make_shared<const std::vector<Line>>(std::move(lines));
    return scene;
  }
  static SceneState make(const std::string& name, Document document) {
    const SceneView view = whirlwind(1.0, 40);
    auto info = std::make_shared<SceneInfo>();
    info->name = name;
    info->facts = {"by formula", "40 helices"};
    info->fields = {"velocity", "vorticity"};
    info->integrators = {"dp54", "bs32", "rk4"};
    info->times = {0.0, 0.5, 1.0};
    info->bounds = view.bounds;
    SceneState scene;
    scene.info = info;
    if (document.input.field.empty()) document.input.field = "velocity";
    if (document.tracing.integrator.empty()) document.tracing.integrator = "dp54";
    if (document.tracing.seeds.empty()) document.tracing.seeds = "random:40";
    scene.lines = view.lines;
    if (!document.view.color.empty() && document.view.color != "speed") {
      LineArray array{.name = document.view.color, .unit = {}, .values = {}};
      for (const Line& line : *view.lines)
        array.values.resize(array.values.size() + line.points.size(), 1.0F);
      scene.color_array = std::make_shared<const LineArray>(std::move(array));
    }
    scene.document = std::move(document);
    for (const Line& line : *view.lines) ++scene.ends[static_cast<std::size_t>(line.end)];
    scene.seeds = 42;
    scene.outside_seeds = 2;
    scene.line_errors = line_errors(*view.lines, view.bounds.diagonal());
    scene.seconds_trace = 0.0123;
    return scene;
  }
};

class FormulaWindow : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
    options_.width = 960;
    options_.height = 640;
    options_.frames = 12;
    options_.program = "flow";
    options_.version = "flow 0";
    options_.session = "whirlwind.palpate.toml";
    if (const char* folder = std::getenv("PALPATE_PICTURES")) {
      options_.screenshot =
          std::filesystem::path(folder) /
          (std::string("window_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".png");
    }
  }

  void at(int frame, InputEvent event) { options_.script.push_back({frame, std::move(event)}); }
  void move(int frame, double x, double y) { at(frame, {.kind = InputKind::kMove, .x = x, .y = y}); }
  void press(int frame, MouseButton button) { at(frame, {.kind = InputKind::kPress, .button = button}); }
  void release(int frame, MouseButton button) { at(frame, {.kind = InputKind::kRelease, .button = button}); }
  void key(int frame, int code, int modifiers = 0) {
    at(frame, {.kind = InputKind::kKeyDown, .key = code, .modifiers = modifiers});
    at(frame + 1, {.kind = InputKind::kKeyUp, .key = code, .modifiers = modifiers});
  }

  void at_control(int frame, InputEvent event, const std::string& control, double across = 0.5) {
    options_.script.push_back({frame, std::move(event), control, 0, across});
  }
  FormulaModel model_;
  WindowOptions options_;
};

}  // namespace palpate::test
