// Slices beside the volume: the same panes by command line and by mouse alone, and back from the session.

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <stb_image.h>

#include "apps/grid/grid_model.h"
#include "apps/grid/grid_verbs.h"
#include "common/cli/command_line.h"
#include "common/cli/window_touch.h"
#include "common/compose/line_view.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/render/slice/slice_panes.h"
#include "common/window/panels/panel.h"
#include "common/window/panels/volume/volume_panel.h"
#include "common/window/window.h"
#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

constexpr int kKeyS = 'S';

class GridPanes : public ExplorerTest {
 protected:
  GridPanes() : ExplorerTest("grid") {
    // v = i + 2 j + 3 k at (i, 2 j, 3 k) of 41 x 21 x 31 voxels.
    std::string voxels;
    for (int k = 0; k < 31; ++k)
      for (int j = 0; j < 21; ++j)
        for (int i = 0; i < 41; ++i) voxels += static_cast<char>(i + 2 * j + 3 * k);
    folder_.write("a_41x21x31_uint8.raw", voxels);
  }

  static std::vector<std::string> with_input(std::vector<std::string> arguments,
                                             const std::vector<std::string>& more) {
    for (const char* word :
         {"a_41x21x31_uint8.raw", "--raw-size", "41x21x31", "--raw-type", "uint8", "--raw-spacing", "1,2,3"})
      arguments.emplace_back(word);
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  Image read_picture(const std::string& name) {
    Image image;
    int channels = 0;
    unsigned char* pixels = stbi_load(folder_.path(name).c_str(), &image.width, &image.height, &channels, 4);
    if (pixels == nullptr) return image;
    image.rgba.assign(pixels, pixels + std::ptrdiff_t{4} * image.width * image.height);
    stbi_image_free(pixels);
    return image;
  }

  WindowResult open(const std::vector<std::string>& arguments) {
    const ParsedCommand parsed = parse_command_line(explorer_, arguments);
    const QuietVerb verb(explorer_);
    WindowOptions window{.program = "grid",
                         .width = kWidth,
                         .height = kHeight,
                         .angles = camera_angles(parsed.options.view.camera),
                         .focal_point = focal_point_of(parsed.options.view),
                         .session = folder_.path("a.palpate.toml"),
                         .picture_folder = folder_.path(),
                         .touch = window_touch(modes_of(FieldKind::kScalar), parsed.options, verb.context),
                         .panels = {draw_volume},
                         .script = script_};
    window.frames = next_ + 20;
    window.screenshot = folder_.path("window.png");
    GridModel model(parsed.options, "grid");
    WindowResult result = run_window(model, window);
    if (const char* folder = std::getenv("PALPATE_PICTURES"))
      std::filesystem::copy(window.screenshot, std::filesystem::path(folder) / "grid_panes.png",
                            std::filesystem::copy_options::overwrite_existing);
    return result;
  }

  void at(InputEvent event) { script_.push_back({next_ += 2, std::move(event)}); }
  void key(int key, int modifiers = 0) {
    at({.kind = InputKind::kKeyDown, .key = key, .modifiers = modifiers});
    at({.kind = InputKind::kKeyUp, .key = key, .modifiers = modifiers});
    next_ += 4;
  }
  void move(const Vec2& to) { at({.kind = InputKind::kMove, .x = to.x, .y = to.y}); }
  void click(const Vec2& place) {
    move(place);
    at({.kind = InputKind::kPress});
    at({.kind = InputKind::kRelease});
    next_ += 4;
  }

  static constexpr int kWidth = 1000, kHeight = 760;
  static constexpr float kTextHeight = 14.0F;
  const Explorer explorer_{.name = "grid", .kind = FieldKind::kScalar, .verbs = {open_volume_verb({})}};
  std::vector<ScriptedEvent> script_;
  int next_ = 4;
};

TEST_F(GridPanes, SlicesSideBySideShowTheValuesOfTheirPlanes) {
  const Json drawn =
      json(with_input({"slice"}, {"--layout", "4", "--cross", "5,30,75", "--window", "200", "--level", "100",
                                  "--size", "402x302", "--out", "four.png"}));
  EXPECT_EQ(drawn["width"], 402);
  EXPECT_EQ(drawn["height"], 302);
  const Image four = read_picture("four.png");
  ASSERT_EQ(four.width, 402);
  // The middle of each pane is the middle of the volume, in its plane: 20, 20, 45 but for one coordinate.
  const auto grey = [](double value) { return 255.0 * value / 200.0; };
  const auto shown = [&](int x, int y) { return four.pixel(x, y)[0]; };
  EXPECT_NEAR(shown(100, 75), grey(20 + 20 + 75), 2.0) << "axial";
  EXPECT_NEAR(shown(100, 226), grey(20 + 30 + 45), 2.0) << "coronal";
  EXPECT_NEAR(shown(301, 226), grey(5 + 20 + 45), 2.0) << "sagittal";
  // Not a patient's: x to the right in axial and coronal panes, z up.
  EXPECT_GT(shown(110, 75), shown(90, 75));
  EXPECT_GT(shown(110, 226), shown(90, 226));
  EXPECT_GT(shown(100, 216), shown(100, 236));

  // A slab of the highest values: half its thickness farther up.
  (void)json(with_input(
      {"render"}, {"--layout", "2", "--pane", "coronal", "--cross", "20,20,0", "--slab", "8", "--slab-rule",
                   "mip", "--window", "200", "--level", "100", "--size", "402x302", "--out", "two.png"}));
  const Image two = read_picture("two.png");
  EXPECT_NEAR(two.pixel(105, 151)[0], grey(20 + 20 + 45 + 3.5) + 0.7, 4.0) << "beside the line at x = 20";

  const auto refused = [&](const std::vector<std::string>& more, const std::string& word) {
    const ProgramResult result = run(with_input({"slice"}, more));
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
  };
  refused({"--layout", "3", "--out", "x.png"}, "1, 2, 4");
  refused({"--layout", "4", "--plane", "axial", "--out", "x.png"}, "--plane is for one slice");
  refused({"--layout", "4", "--cross", "1,2", "--out", "x.png"}, "--cross");
  refused({"--layout", "4", "--slice-turn", "0,0,0,0", "--out", "x.png"}, "--slice-turn");
  refused({"--layout", "4", "--out", "x.nii"}, ".png");
  refused({"--layout", "4"}, "--out");
  refused({"--slab", "5", "--out", "x.png"}, "--layout 2 and 4");
  refused({"--size", "40x40", "--out", "x.png"}, "--spacing");
  const auto noted = [&](const std::vector<std::string>& more, const std::string& word) {
    const ProgramResult result = run(with_input({"render"}, more));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
  };
  noted({"--slab", "5", "--size", "40x30", "--out", "n.png", "--force"}, "no slices");
  noted({"--layout", "4", "--cross", "1e6,0,0", "--size", "40x30", "--out", "n.png", "--force"},
        "outside the volume");
  noted({"--layout", "4", "--slice-blend", "0.5", "--size", "40x30", "--out", "n.png", "--force"}, "--field");
  EXPECT_FALSE(std::filesystem::exists(folder_.path("x.png")));
}

TEST_F(GridPanes, ByMouseAloneAndBackFromTheSession) {
  if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
  const PictureArea area = layout(kWidth, kHeight, kTextHeight).picture;
  key(kKeyS);
  key(kKeyS);
  // A quarter of the way into the axial pane, at the upper left.
  const Vec2 mouse{area.left + 0.25 * area.width + 12.0, area.top + 0.25 * area.height - 9.0};
  click(mouse);
  at({.kind = InputKind::kWheel, .y = 1.0});
  at({.kind = InputKind::kWheel, .y = 1.0});
  at({.kind = InputKind::kPress, .button = MouseButton::kRight});
  move(mouse + Vec2(40.0, 0.0));
  at({.kind = InputKind::kRelease, .button = MouseButton::kRight});
  next_ += 4;
  key('S', kModifierControl);
  const std::string file = folder_.path("a_41x21x31_uint8.raw").string();
  const std::vector<std::string> input{file,    "--raw-size",    "41x21x31", "--raw-type",
                                       "uint8", "--raw-spacing", "1,2,3"};
  const WindowResult made = open(input);
  ASSERT_TRUE(made.view.volume);
  const SlicePanes& panes = made.view.volume->panes;
  EXPECT_EQ(panes.layout, 4);
  EXPECT_GT(panes.cross.x, 20.0);
  EXPECT_GT(panes.cross.y, 20.0);
  EXPECT_NEAR(panes.cross.z, 45.0 - 2.0 * 3.0, 1e-9) << "two voxels away from the viewer";
  ASSERT_TRUE(made.view.volume->planes.window);
  ASSERT_EQ(made.message.rfind("saved ", 0), 0U) << made.message;

  std::filesystem::path saved;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
    if (entry.path().extension() == ".toml") saved = entry.path();
  ASSERT_FALSE(saved.empty());
  script_.clear();
  next_ = 4;
  move({150.0, 20.0});  // over no pane and no control
  const WindowResult again = open({"open", "--session", saved.string()});
  ASSERT_TRUE(again.view.volume);
  EXPECT_TRUE(again.view.volume->panes == panes);
  EXPECT_EQ(again.view.volume->planes.window, made.view.volume->planes.window);
  // Without a display it is the same picture, but for the panel: the slices, to the pixel.
  const int width = static_cast<int>(area.width), height = static_cast<int>(area.height);
  (void)json({"render", "--session", saved.string(), "--size",
              std::to_string(width) + "x" + std::to_string(height), "--out", "headless.png", "--force"});
  const Image window = read_picture("window.png"), headless = read_picture("headless.png");
  for (const Pane& pane : panes_of(panes, width, height)) {
    if (!pane.plane) continue;
    int worst = 0;
    constexpr int kBanners = 60;
    for (int y = pane.top; y < pane.top + pane.height - kBanners; ++y)
      for (int x = pane.left; x < pane.left + pane.width; ++x)
        worst = std::max(
            worst, std::abs(window.pixel(static_cast<int>(area.left) + x, y)[0] - headless.pixel(x, y)[0]));
    EXPECT_LE(worst, 1) << kSlicePlaneNames[static_cast<std::size_t>(*pane.plane)];
  }
}

}  // namespace
}  // namespace palpate::test
