#include "common/window/window.h"

#include <atomic>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <gtest/gtest.h>
#include <stb_image.h>

#include "common/base/error.h"
#include "common/compose/view_keep.h"
#include "common/render/png.h"
#include "common/render/render_image.h"
#include "common/window/panels/panel.h"
#include "tests/common/render/sample_scenes.h"
#include "tests/support/png_texts.h"

namespace palpate {
namespace {

constexpr int kEnter = 257;

// Lines by formula; files named "bad…" cannot be opened.
class FakeModel : public WindowModel {
 public:
  SceneState start(Progress&) override {
    Document document;
    document.view.color = first_array.empty() ? "speed" : first_array;
    return make("whirlwind", document);
  }
  SceneState open(const InputFiles& input, Progress&) override {
    const auto& files = input.files;
    ++opened;
    if (files.front().string().starts_with("bad")) {
      throw input_error({.file = files.front().string(), .found = "not a data file"});
    }
    return make(files.front().string(), {});
  }
  SceneState update(const Document& document, Progress&) override {
    ++updated;
    return make("whirlwind", document);
  }
  void keep(const SceneView& view, Document& document) const override { keep_camera(view, document); }
  std::string save_session(const Document&) override {
    ++saved;
    return "whirlwind.toml";
  }

  std::atomic<int> opened{0}, updated{0}, saved{0};
  std::string first_array;

 private:
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
    scene.error_max = 3e-7;
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

// Edits of any part, in the order of acts: the view is turned, then lines are traced backward; both are taken
// back, and restored.
TEST_F(WindowTest, EditsAreTakenBackAndRestoredInTheirOrder) {
  options_.frames = 60;
  move(2, 600, 300);
  press(3, MouseButton::kLeft);
  for (int i = 0; i < 8; ++i) move(4 + i, 610 + 10 * i, 300);
  release(12, MouseButton::kLeft);
  key(20, 'Z', kModifierControl);
  const Camera first = make_camera({Vec3(-1.0), Vec3(1.0)}, {}, 1.0);
  const WindowResult undone = run_window(model_, options_);
  EXPECT_EQ(undone.message, "undone");
  EXPECT_LT(glm::distance(first.axes[2], undone.view.camera.axes[2]), 1e-9) << "a drag is one edit";
  key(30, 'Z', kModifierControl | kModifierShift);
  const WindowResult restored = run_window(model_, options_);
  EXPECT_EQ(restored.message, "restored");
  EXPECT_GT(glm::distance(first.axes[2], restored.view.camera.axes[2]), 0.3);
  key(40, 'Z', kModifierControl);
  key(50, 'Z', kModifierControl);
  EXPECT_EQ(run_window(model_, options_).message, "nothing to undo");
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
