#include "common/window/window.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <stb_image.h>

#include "common/compose/view_keep.h"
#include "common/render/png.h"
#include "common/render/render_image.h"
#include "common/window/panels/color_panel.h"
#include "common/window/panels/panel.h"
#include "common/window/panels/panel_parts.h"
#include "common/window/panels/seed_panel.h"
#include "tests/common/window/formula_window.h"
#include "tests/support/png_texts.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

constexpr int kEnter = 257;

class WindowTest : public FormulaWindow {};

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
  const TempFolder folder;
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
  FormulaModel still;
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
  const auto texts = png_texts(bytes);
  ASSERT_EQ(texts.size(), 2U);
  EXPECT_EQ(texts[1].text, "flow --example tornado");
  std::filesystem::remove(options_.screenshot);
}

// What warns of a new input lies over the picture until it is closed; other words wait behind a button.
TEST_F(WindowTest, AWarningIsABannerFromTheBeginning) {
  options_.frames = 12;
  at_control(4, {.kind = InputKind::kMove}, "1 note");
  model_.notes = {"a word on the data", "WARNING: the axes are wrong; turn them"};
  EXPECT_EQ(run_window(model_, options_).missing, std::vector<std::string>())
      << "the other one alone is behind it";
  model_.notes = {"a word on the data", "another one"};
  EXPECT_EQ(run_window(model_, options_).missing, std::vector<std::string>{"1 note"}) << "two are";
}

}  // namespace
}  // namespace palpate::test
