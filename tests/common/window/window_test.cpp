#include "common/window/window.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <stb_image.h>

#include "common/base/error.h"
#include "common/compose/view_keep.h"
#include "common/render/png.h"
#include "common/render/render_image.h"
#include "common/window/panels/color_panel.h"
#include "common/window/panels/panel.h"
#include "common/window/panels/panel_parts.h"
#include "common/window/panels/seed_panel.h"
#include "tests/common/render/sample_scenes.h"
#include "tests/support/png_texts.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

constexpr int kEnter = 257;

// Lines by formula; files named "bad…" cannot be opened.
class FakeModel : public WindowModel {
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

 private:
  SceneState scene_of(const std::string& name, const Document& document) const {
    SceneState scene = make(name, document);
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
    const SceneView view = test::whirlwind(1.0, 40);
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

class WindowTest : public ::testing::Test {
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
  void undo(int frame) { key(frame, 'Z', kModifierControl); }
  void redo(int frame) { key(frame, 'Z', kModifierControl | kModifierShift); }
  /// Frames of 8 ms at least, which go on while the first update takes longer than they all, but is cancelled.
  void update_slowly() {
    model_.rests = 6000;
    options_.frames_wait = false;
    options_.frames = 160;
    options_.stop_requested = [] {
      std::this_thread::sleep_for(std::chrono::milliseconds(8));
      return false;
    };
  }

  FakeModel model_;
  WindowOptions options_;
};

TEST_F(WindowTest, ShowsTheSceneAndClosesAfterItsFrames) {
  const WindowResult result = run_window(model_, options_);
  EXPECT_EQ(result.frames, 12);
  EXPECT_EQ(result.document.tracing.seeds, "random:40");
  EXPECT_GT(result.median_frame_ms, 0.0);
}

// Ctrl-C is asked about before each frame.
TEST_F(WindowTest, EndsWithTheFrameInWhichItIsStopped) {
  constexpr int kThen = 20;
  options_.frames = 4 * kThen;
  int asked = 0;
  options_.stop_requested = [&asked] { return ++asked >= kThen; };
  EXPECT_LT(run_window(model_, options_).frames, kThen);
  EXPECT_EQ(asked, kThen);
}

TEST_F(WindowTest, LeftDragTurnsTheView) {
  move(2, 600, 300);
  press(3, MouseButton::kLeft);
  move(4, 700, 300);
  release(5, MouseButton::kLeft);
  move(6, 800, 500);  // nothing is held any more
  const WindowResult result = run_window(model_, options_);
  const double aspect = 1.0;  // the direction of view does not depend on it
  const Camera before = make_camera({Vec3(-1.0), Vec3(1.0)}, {}, aspect);
  Camera turned = before;
  turn(turned, 3.14159265358979 * 100.0 / 606.0, 0.0);  // 640 less the status line
  EXPECT_GT(glm::distance(before.axes[2], result.view.camera.axes[2]), 0.3);
  EXPECT_LT(glm::distance(turned.axes[2], result.view.camera.axes[2]), 1e-9);
}

TEST_F(WindowTest, EnterResetsTheCamera) {
  move(2, 600, 300);
  press(3, MouseButton::kLeft);
  move(4, 700, 200);
  release(5, MouseButton::kLeft);
  key(7, kEnter);
  const WindowResult result = run_window(model_, options_);
  const Camera first = make_camera({Vec3(-1.0), Vec3(1.0)}, {}, 1.0);
  EXPECT_LT(glm::distance(first.axes[2], result.view.camera.axes[2]), 1e-12);
}

TEST_F(WindowTest, DragOverThePanelLeavesTheViewAlone) {
  move(2, 100, 500);
  press(3, MouseButton::kLeft);
  move(4, 200, 520);
  release(5, MouseButton::kLeft);
  const WindowResult result = run_window(model_, options_);
  const Camera first = make_camera({Vec3(-1.0), Vec3(1.0)}, {}, 1.0);
  EXPECT_LT(glm::distance(first.axes[2], result.view.camera.axes[2]), 1e-12);
}

TEST_F(WindowTest, FileThatCannotBeOpenedGivesALineAndTheSceneStays) {
  at(2, {.kind = InputKind::kDrop, .files = {"bad.vtk"}});
  const WindowResult result = run_window(model_, options_);
  EXPECT_EQ(model_.opened, 1);
  EXPECT_NE(result.message.find("bad.vtk"), std::string::npos) << result.message;
  EXPECT_EQ(result.document.input.field, "velocity");
  EXPECT_EQ(result.frames, 12);
}

TEST_F(WindowTest, DroppedFileIsOpened) {
  at(2, {.kind = InputKind::kDrop, .files = {"good.vtk"}});
  const WindowResult result = run_window(model_, options_);
  EXPECT_EQ(model_.opened, 1);
  EXPECT_EQ(result.message, "");
}

// As the manual has them (NASA TM-101067, ch. 8): without marks, single precision, 2 x 2 x 2 points.
TEST_F(WindowTest, AGridAndItsSolutionAreDroppedTogetherInAnyOrder) {
  const test::TempFolder folder;
  const auto file_of = [&](const std::string& name, int numbers) {
    std::string bytes;
    for (int i = 0; i < 3 + numbers; ++i) {
      const float number = 0.5F * static_cast<float>(i % 4);
      const std::int32_t side = 2;
      std::array<char, 4> four{};
      std::memcpy(four.data(), i < 3 ? static_cast<const void*>(&side) : &number, four.size());
      bytes.append(four.data(), four.size());
    }
    return folder.write(name, bytes);
  };
  const std::filesystem::path grid = file_of("xyz.bin", 3 * 8), solution = file_of("q.bin", 4 + 5 * 8);
  for (const std::vector<std::filesystem::path>& both :
       {std::vector{grid, solution}, std::vector{solution, grid}}) {
    options_.script.clear();
    at(2, {.kind = InputKind::kDrop, .files = both});
    (void)run_window(model_, options_);
    EXPECT_EQ(model_.last_opened, (InputFiles{{grid}, solution}));
  }
  options_.script.clear();
  at(2, {.kind = InputKind::kDrop, .files = {solution}});
  (void)run_window(model_, options_);
  EXPECT_EQ(model_.last_opened, (InputFiles{{solution}, {}})) << "there is no grid that it goes with";
  model_.files_of_scene = {grid};
  (void)run_window(model_, options_);
  EXPECT_EQ(model_.last_opened, (InputFiles{{grid}, solution})) << "with the one that is open";
}

TEST_F(WindowTest, HelpAndRatesAreShownAndSessionsSaved) {
  key(2, 'H');
  key(4, 'T');
  key(6, 'S', kModifierControl);
  const WindowResult result = run_window(model_, options_);
  EXPECT_EQ(model_.saved, 1);
  EXPECT_EQ(result.message, "saved whirlwind.toml");
}

TEST_F(WindowTest, SpacePlaysTheTimeSteps) {
  options_.play_rate = 1e6;  // as fast as they come
  key(2, ' ');
  const WindowResult result = run_window(model_, options_);
  EXPECT_GT(model_.updated, 2);
  EXPECT_NE(result.document.input.time, "");
}

// A colour means the same at all steps; other lines, and another quantity, have a range of their own.
TEST_F(WindowTest, ColoursKeepTheirRangeWhileTimePlays) {
  model_.hurries = true;
  options_.frames = 40;
  const WindowResult first = run_window(model_, options_);
  const ValueRange usual = value_range(*first.view.lines, first.view.style);
  key(4, '.');
  key(12, '.');
  const WindowResult played = run_window(model_, options_);
  EXPECT_EQ(played.document.input.time, "1");
  EXPECT_EQ(value_range(*played.view.lines, played.view.style), usual);
  EXPECT_GT(value_range(*played.view.lines, {}).upper, 2.0 * usual.upper) << "its own";
  EXPECT_FALSE(played.view.style.range) << "which is still automatic";
  options_.panels = {[](PanelContext& on) { draw_seeds(on.state, true); }, draw_line_colors};
  options_.frames = 60;
  at_control(20, {.kind = InputKind::kPress}, "automatic range");
  release(22, MouseButton::kLeft);
  at_control(26, {.kind = InputKind::kPress}, "automatic range");
  release(28, MouseButton::kLeft);
  const WindowResult again = run_window(model_, options_);
  EXPECT_TRUE(again.missing.empty());
  EXPECT_EQ(value_range(*again.view.lines, again.view.style), value_range(*again.view.lines, {}))
      << "off and on: of this step";
}

TEST_F(WindowTest, EscapeClosesAnOpenListAndNothingElse) {
  constexpr int kEscape = 256;
  options_.frames = 30;
  const auto choose_light = [&](int frame) {
    at_control(frame, {.kind = InputKind::kPress}, "background");
    release(frame + 2, MouseButton::kLeft);
  };
  choose_light(2);
  at_control(12, {.kind = InputKind::kPress}, "light");
  release(14, MouseButton::kLeft);
  const WindowResult chosen = run_window(model_, options_);
  EXPECT_TRUE(chosen.missing.empty());
  EXPECT_EQ(chosen.view.background, Background::kLight);
  options_.script.clear();
  key(1, 'H');
  choose_light(3);
  key(8, kEscape);
  at_control(12, {.kind = InputKind::kPress}, "light");
  release(14, MouseButton::kLeft);
  const WindowResult closed = run_window(model_, options_);
  EXPECT_EQ(closed.missing, std::vector<std::string>{"light"}) << "the list is gone";
  EXPECT_EQ(closed.view.background, Background::kDark);
}

TEST_F(WindowTest, EveryKeySaysWhyItDoesNothing) {
  constexpr int kUp = 265, kPageDown = 267;
  FakeModel still;
  still.one_time = true;
  for (const int code : std::initializer_list<int>{'V', 'L', '[', 'C', 'G', 'K', 'R', 'X', '1', ' ', '.', ',',
                                                   'J', '5', kUp, kPageDown}) {
    options_.script.clear();
    key(4, code);
    EXPECT_NE(run_window(still, options_).message, "") << code;
  }
}

// All of it is reached in a small window: it scrolls.
TEST_F(WindowTest, TheSheetOfKeysFitsIntoASmallWindow) {
  for (const auto& [width, height] : {std::pair(800, 600), std::pair(520, 300)}) {
    options_.width = width;
    options_.height = height;
    options_.script.clear();
    key(2, 'H');
    (void)run_window(model_, options_);
    const auto& drawn = drawn_controls();
    const auto sheet =
        std::ranges::find_if(drawn, [](const DrawnControl& control) { return control.label == "keys"; });
    ASSERT_NE(sheet, drawn.end());
    EXPECT_GE(sheet->left, 0.0);
    EXPECT_GE(sheet->top, 0.0);
    EXPECT_LE(sheet->left + sheet->width, width);
    EXPECT_LE(sheet->top + sheet->height, height);
    EXPECT_GT(sheet->height, 0.5 * height);
  }
}

Image read_picture(const std::filesystem::path& path) {
  Image image;
  int channels = 0;
  stbi_uc* pixels = stbi_load(path.c_str(), &image.width, &image.height, &channels, 4);
  if (pixels != nullptr) image.rgba.assign(pixels, pixels + 4 * image.width * image.height);
  std::free(pixels);
  return image;
}

TEST_F(WindowTest, ItsPictureIsTheOneDrawnWithoutADisplay) {
  options_.screenshot = std::filesystem::temp_directory_path() / "palpate_same_picture.png";
  move(2, 600, 300);
  press(3, MouseButton::kLeft);
  move(4, 650, 280);
  release(5, MouseButton::kLeft);
  const WindowResult result = run_window(model_, options_);
  const Image window = read_picture(options_.screenshot);
  std::filesystem::remove(options_.screenshot);
  ASSERT_EQ(window.width, options_.width);
  constexpr float kTextHeight = 14.0F;
  const PictureArea area = layout(options_.width, options_.height, kTextHeight).picture;
  const auto left = static_cast<int>(area.left);
  const Image expected =
      render_image(result.view, static_cast<int>(area.width), static_cast<int>(area.height)).image;
  int different = 0;
  for (int y = 0; y < expected.height; ++y) {
    for (int x = 0; x < expected.width; ++x)
      different += window.pixel(left + x, y) == expected.pixel(x, y) ? 0 : 1;
  }
  EXPECT_EQ(different, 0);
}

// A drag is one step, and so is a key; where it is seen from is none.
TEST_F(WindowTest, EditsAreTakenBackAndRestoredInTheirOrder) {
  options_.frames = 36;
  const double width = options_.view.style.width;
  at_control(2, {.kind = InputKind::kPress}, "line width", 0.3);
  for (int i = 0; i < 8; ++i) at_control(4 + i, {.kind = InputKind::kMove}, "line width", 0.4 + 0.05 * i);
  release(14, MouseButton::kLeft);
  key(18, '.');
  move(22, 600, 300);
  press(23, MouseButton::kLeft);
  for (int i = 0; i < 4; ++i) move(24 + i, 620 + 20 * i, 300);
  release(30, MouseButton::kLeft);
  const WindowResult edited = run_window(model_, options_);
  EXPECT_GT(edited.view.style.width, width + 1.0);
  EXPECT_EQ(edited.document.input.time, "0.5");
  const Vec3 seen_along = edited.view.camera.axes[2];
  EXPECT_GT(glm::distance(seen_along, make_camera({Vec3(-1.0), Vec3(1.0)}, {}, 1.0).axes[2]), 0.3);

  const auto expect = [&](const char* message, double thick, const char* time) {
    options_.frames = options_.script.back().frame + 6;
    const WindowResult result = run_window(model_, options_);
    EXPECT_EQ(result.message, message);
    EXPECT_EQ(result.view.style.width, thick);
    EXPECT_EQ(result.document.view.line_width.value_or(width), thick);
    EXPECT_EQ(result.document.input.time, time);
    EXPECT_LT(glm::distance(result.view.camera.axes[2], seen_along), 1e-9) << "the camera stays";
  };
  const double thick = edited.view.style.width;
  undo(36);
  expect("undone", thick, "");
  undo(42);
  expect("undone", width, "");
  undo(48);
  expect("nothing to undo", width, "");
  redo(54);
  expect("restored", thick, "");
  key(60, 'Y', kModifierControl);
  expect("restored", thick, "0.5");
  redo(66);
  expect("nothing to restore", thick, "0.5");
  undo(72);
  key(78, '.');  // another edit: what was undone is gone
  redo(84);
  expect("nothing to restore", thick, "0.5");
}

TEST_F(WindowTest, ANumberTypedIntoAFieldOfSeedsIsOneStep) {
  constexpr int kControl = 341;
  options_.frames = 60;
  options_.panels = {[](PanelContext& on) { draw_seeds(on.state, true); }};
  at(2, {.kind = InputKind::kKeyDown, .key = kControl});
  at_control(3, {.kind = InputKind::kPress}, "number");
  release(5, MouseButton::kLeft);
  at(7, {.kind = InputKind::kKeyUp, .key = kControl, .modifiers = kModifierControl});
  for (int i = 0; i < 2; ++i) {
    key(10 + 3 * i, '7');
    at(10 + 3 * i, {.kind = InputKind::kText, .key = '7'});
  }
  key(18, kEnter);
  const WindowResult typed = run_window(model_, options_);
  EXPECT_EQ(typed.document.tracing.seeds, "random:77");
  EXPECT_GT(model_.updated, 0);
  undo(30);
  EXPECT_EQ(run_window(model_, options_).document.tracing.seeds, "random:40");
  redo(40);
  const WindowResult restored = run_window(model_, options_);
  EXPECT_EQ(restored.document.tracing.seeds, "random:77");
  EXPECT_EQ(restored.message, "restored");
}

// The one that runs makes way for the next, and neither drops what was asked for.
TEST_F(WindowTest, AnEditWhileAnUpdateRunsIsKept) {
  update_slowly();
  key(5, '.');
  key(80, '.');  // after the patience with the first
  const WindowResult result = run_window(model_, options_);
  EXPECT_EQ(result.document.input.time, "1");
  EXPECT_EQ(model_.updated, 2);
}

TEST_F(WindowTest, UndoGoesThroughAnUpdate) {
  update_slowly();
  key(5, '.');
  undo(80);
  const WindowResult undone = run_window(model_, options_);
  EXPECT_EQ(undone.document.input.time, "");
  EXPECT_EQ(undone.message, "undone");
  redo(90);
  EXPECT_EQ(run_window(model_, options_).document.input.time, "0.5");
  at_control(100, {.kind = InputKind::kPress}, "line width", 0.9);
  release(102, MouseButton::kLeft);
  undo(110);
  const WindowResult result = run_window(model_, options_);
  EXPECT_EQ(result.document.input.time, "0.5") << "the step before";
  EXPECT_EQ(result.view.style.width, options_.view.style.width);
}

TEST_F(WindowTest, AnEditThatFailsIsNoStep) {
  options_.frames = 40;
  model_.refused = "1";
  key(4, '.');
  key(10, '.');
  const WindowResult failed = run_window(model_, options_);
  EXPECT_NE(failed.message.find("no such time"), std::string::npos) << failed.message;
  EXPECT_EQ(failed.document.input.time, "0.5");
  undo(20);
  EXPECT_EQ(run_window(model_, options_).document.input.time, "");
}

TEST_F(WindowTest, ArrayOfTheDataColoursTheLines) {
  model_.first_array = "temperature";
  const WindowResult result = run_window(model_, options_);
  EXPECT_EQ(result.view.style.color_by, ColorBy::kArray);
  ASSERT_TRUE(result.view.style.array);
  EXPECT_EQ(result.view.style.array->name, "temperature");
  EXPECT_EQ(result.document.view.color, "temperature");
}

TEST_F(WindowTest, QuitEndsIt) {
  key(4, 'Q');
  EXPECT_EQ(run_window(model_, options_).frames, 5);
}

TEST_F(WindowTest, ScreenshotSaysHowItWasMade) {
  options_.screenshot = std::filesystem::temp_directory_path() / "palpate_window_test.png";
  options_.command_line = "flow --example tornado";
  (void)run_window(model_, options_);
  std::ifstream file(options_.screenshot, std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
  const auto texts = test::png_texts(bytes);
  ASSERT_EQ(texts.size(), 2U);
  EXPECT_EQ(texts[1].text, "flow --example tornado");
  std::filesystem::remove(options_.screenshot);
}

}  // namespace
}  // namespace palpate
