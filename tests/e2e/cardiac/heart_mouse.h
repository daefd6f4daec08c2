/// cardiac's window, led by the mouse alone: from the start page on, in a folder of its own.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <stb_image.h>

#include "apps/cardiac/cardiac_model.h"
#include "apps/cardiac/cardiac_verbs.h"
#include "common/base/index.h"
#include "common/cli/command_line.h"
#include "common/cli/window_touch.h"
#include "common/compose/appearance.h"
#include "common/compose/line_view.h"
#include "common/field/data_set.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/window/panels/panel.h"
#include "common/window/window.h"
#include "tests/e2e/explorer_test.h"
#include "tests/support/project_folders.h"

namespace palpate::test {

/// The mean of a cell's points.
inline Vec3 middle_of(const UnstructuredTopology& cells, std::size_t cell) {
  Vec3 sum{0.0};
  const std::int64_t first = cells.offsets[cell], end = cells.offsets[cell + 1];
  for (std::int64_t i = first; i < end; ++i)
    for (int axis = 0; axis < 3; ++axis)
      sum[axis] += cells.positions.at(as_size(cells.connectivity[as_size(i)]), axis);
  return sum / static_cast<double>(end - first);
}

class CardiacMouse : public ExplorerTest {
 protected:
  CardiacMouse() : ExplorerTest("cardiac") {}
  void SetUp() override {
    if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
    before_ = std::filesystem::current_path();
    std::filesystem::current_path(folder_.path());  // where the dialog begins
    if (const char* home = std::getenv("HOME")) home_ = home;
    setenv("HOME", folder_.path().c_str(), 1);  // where a session is proposed
  }
  void TearDown() override {
    if (before_.empty()) return;
    std::filesystem::current_path(before_);
    setenv("HOME", home_.c_str(), 1);
  }

  /// Runs the script so far, which begins anew. Without a file it begins with the start page.
  /// @param page the picture of docs/guide that PALPATE_WRITE_PAGES makes of it; empty: none.
  WindowResult open(std::vector<std::string> arguments, const std::string& page = {}) {
    arguments.insert(arguments.begin(), "open");
    arguments.insert(arguments.end(), {"--threads", "1"});
    const ParsedCommand parsed = parse_command_line(explorer_, arguments);
    const QuietVerb verb(explorer_);
    const Document& options = parsed.options;
    WindowOptions window{.program = "cardiac",
                         .width = width_,
                         .height = height_,
                         .angles = camera_angles(options.view.camera),
                         .focal_point = focal_point_of(options.view),
                         .kind = FieldKind::kFibre,
                         .start_page = options.input.files.empty() && options.input.example.empty(),
                         .session = options.common.session,
                         .picture_folder = folder_.path(),
                         .touch = window_touch(modes_of(FieldKind::kFibre), options, verb.context),
                         .panels = cardiac_panels(),
                         .threads = 1,
                         // The servo has the time between two frames that a user would give it.
                         .stop_requested =
                             [] {
                               std::this_thread::sleep_for(std::chrono::milliseconds(8));
                               return false;
                             },
                         .script = std::exchange(script_, {}),
                         .frames = std::exchange(next_, kFirst) + 30,
                         .patience = patience_,
                         .hidden = true};
    apply_appearance(options, window.view);
    window.screenshot = folder_.path("window.png");
    CardiacModel model(options, "cardiac");
    WindowResult result = run_window(model, window);
    EXPECT_EQ(result.missing, std::vector<std::string>()) << "controls that no panel had";
    if (!page.empty() && std::getenv("PALPATE_WRITE_PAGES") != nullptr)
      std::filesystem::copy_file(window.screenshot, source_folder() / "docs" / "guide" / page,
                                 std::filesystem::copy_options::overwrite_existing);
    if (const char* folder = std::getenv("PALPATE_PICTURES"))
      std::filesystem::copy_file(window.screenshot,
                                 std::filesystem::path(folder) /
                                     (std::string("cardiac_mouse_") + std::to_string(opened_++) + ".png"),
                                 std::filesystem::copy_options::overwrite_existing);
    return result;
  }

  void at(InputEvent event, const std::string& control = {}) {
    script_.push_back({.frame = next_ += 3, .event = std::move(event), .control = control});
  }
  /// What was asked for has these to come.
  void next_frames(int count) { next_ += count; }
  void press(const std::string& control) {
    at({.kind = InputKind::kMove}, control);
    at({.kind = InputKind::kPress});
    at({.kind = InputKind::kRelease});
    next_ += 6;
  }
  /// From the start page, or from what is open.
  void choose_file(const std::string& name) {
    press("Open…");
    press(name);
    press("Open");
    next_ += 30;
  }
  [[nodiscard]] PictureArea area() const {
    constexpr float kLetterHeight = 14.0F;
    return layout(width_, height_, kLetterHeight).picture;
  }
  /// A place of the picture, from its upper left corner to the lower right one, to which the mouse goes.
  void move_to(double across, double down) {
    at({.kind = InputKind::kMove,
        .x = area().left + across * area().width,
        .y = area().top + down * area().height});
  }
  /// Takes the probe at a place of the picture, from its upper left corner to the lower right one.
  void grab_at(double across, double down) {
    press("mode");
    press("fibre");
    press("Grab");
    move_to(across, down);
    at({.kind = InputKind::kPress});
    next_ += 20;
  }

  [[nodiscard]] Image picture(const std::string& name) const {
    Image image;
    unsigned char* pixels = stbi_load(folder_.path(name).c_str(), &image.width, &image.height, nullptr, 4);
    EXPECT_NE(pixels, nullptr) << name;
    if (pixels != nullptr) image.rgba.assign(pixels, pixels + 4L * image.width * image.height);
    stbi_image_free(pixels);
    return image;
  }
  void save_session_and_picture() {
    press("Save session");
    press("Save");
    press("Save picture");
  }
  /// Opens the session that was saved, which is to give the picture that was saved, to `off` of 255. @return its name.
  std::string reopened(const WindowResult& saved, WindowResult& again, int off = 1) {
    std::string session, first;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      const std::string name = entry.path().filename().string();
      if (name.ends_with(".palpate.toml")) session = name;
      if (name.starts_with("cardiac-") && name.ends_with(".png")) first = name;
    }
    EXPECT_FALSE(session.empty()) << saved.log;
    EXPECT_FALSE(first.empty()) << saved.log;
    if (session.empty() || first.empty()) return session;
    std::filesystem::rename(folder_.path(first), folder_.path("first.png"));
    choose_file(session);
    press("Save picture");
    again = open({});
    const Image a = picture("first.png"), b = picture(first);
    EXPECT_EQ(a.rgba.size(), b.rgba.size());
    int worst = 0;
    for (std::size_t i = 0; i < std::min(a.rgba.size(), b.rgba.size()); ++i)
      worst = std::max(worst, std::abs(a.rgba[i] - b.rgba[i]));
    RecordProperty("picture_of_the_session_differs_by_of_255", worst);
    EXPECT_LE(worst, off) << "of 255, a session later";
    return session;
  }

  static constexpr int kFirst = 30;
  int width_ = 1000, height_ = 900;
  double patience_ = 60.0;  // [s]

 private:
  const Explorer explorer_{.name = "cardiac", .kind = FieldKind::kFibre, .verbs = {open_heart_verb({})}};
  std::vector<ScriptedEvent> script_;
  int next_ = kFirst, opened_ = 0;
  std::filesystem::path before_;
  std::string home_;
};

}  // namespace palpate::test
