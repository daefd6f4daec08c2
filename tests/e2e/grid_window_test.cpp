// A user with nothing but a mouse: the tooth, two planes, a lens, a length, all saved; and a window that is
// opened from the session has them again.
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <stb_image.h>

#include "apps/grid/grid_model.h"
#include "apps/grid/grid_verbs.h"
#include "common/cli/command_line.h"
#include "common/cli/window_touch.h"
#include "common/compose/line_view.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/render/render_image.h"
#include "common/window/panels/panel.h"
#include "common/window/panels/volume/volume_panel.h"
#include "common/window/window.h"
#include "tests/e2e/explorer_test.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

class GridWindow : public ExplorerTest {
 protected:
  GridWindow() : ExplorerTest("grid") {
    const PictureArea area = layout(kWidth, kHeight, kTextHeight).picture;
    middle_ = {area.left + 0.5 * area.width, 0.5 * area.height, 0.0};
  }
  void SetUp() override {
    if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
    PALPATE_NEED_DATA(tooth, "grid/tooth/tooth.nhdr");
    for (const auto& file : std::filesystem::directory_iterator(tooth.parent_path()))
      std::filesystem::copy(file, folder_.path(file.path().filename().string()));
  }

  /// What the command line says, in a window.
  WindowResult open(const std::vector<std::string>& arguments, const std::string& picture) {
    const ParsedCommand parsed = parse_command_line(explorer_, arguments);
    const QuietVerb verb(explorer_);
    WindowOptions window{.program = "grid",
                         .width = kWidth,
                         .height = kHeight,
                         .angles = camera_angles(parsed.options.view.camera),
                         .focal_point = focal_point_of(parsed.options.view),
                         .picture_folder = folder_.path(),
                         .touch = window_touch(modes_of(FieldKind::kScalar), parsed.options, verb.context),
                         .panels = {draw_volume},
                         // Frames of some length: between two events the servo has time to answer.
                         .stop_requested =
                             [] {
                               std::this_thread::sleep_for(std::chrono::milliseconds(8));
                               return false;
                             },
                         .script = script_};
    window.frames = next_ + rest_;
    window.patience = 60.0;
    if (parsed.options.view.frame_budget > 0.0) window.frame_budget = parsed.options.view.frame_budget;
    window.screenshot = folder_.path("window.png");
    window.session = folder_.path("tooth.palpate.toml");
    GridModel model(parsed.options, "grid");
    WindowResult result = run_window(model, window);
    if (const char* folder = std::getenv("PALPATE_PICTURES"))
      std::filesystem::copy(window.screenshot,
                            std::filesystem::path(folder) / ("grid_window_" + picture + ".png"),
                            std::filesystem::copy_options::overwrite_existing);
    return result;
  }

  /// What the last window showed, without its panel.
  Image picture() {
    int width = 0, height = 0, channels = 0;
    unsigned char* pixels = stbi_load(folder_.path("window.png").c_str(), &width, &height, &channels, 4);
    if (pixels == nullptr) return {};
    const PictureArea area = layout(kWidth, kHeight, kTextHeight).picture;
    Image image{.width = static_cast<int>(area.width), .height = static_cast<int>(area.height), .rgba = {}};
    for (int y = 0; y < image.height; ++y) {
      const auto* row = pixels + 4 * (y * width + static_cast<int>(area.left));
      image.rgba.insert(image.rgba.end(), row, row + 4 * image.width);
    }
    stbi_image_free(pixels);
    return image;
  }

  void at(InputEvent event) { script_.push_back({next_ += 2, std::move(event)}); }
  void move(double x, double y) { at({.kind = InputKind::kMove, .x = x, .y = y}); }
  void click(double x, double y) {
    move(x, y);
    at({.kind = InputKind::kPress});
    at({.kind = InputKind::kRelease});
    next_ += 6;
  }
  /// On a control of the panel, by its label.
  void press(const std::string& label) {
    for (const InputKind kind : {InputKind::kMove, InputKind::kPress, InputKind::kRelease})
      script_.push_back({.frame = next_ += 2, .event = {.kind = kind}, .control = label});
    next_ += 6;
  }
  /// From the middle of the picture, and on by as much again.
  void drag(double dx, double dy) {
    constexpr int kSteps = 12;
    move(middle_.x, middle_.y);
    at({.kind = InputKind::kPress});
    for (int i = 1; i <= kSteps; ++i) move(middle_.x + dx * i / kSteps, middle_.y + dy * i / kSteps);
    at({.kind = InputKind::kRelease});
    next_ += 6;
  }
  void scroll(double notches) {
    move(285.0, 500.0);  // over no list or slider
    for (int i = 0; i < 3; ++i) at({.kind = InputKind::kWheel, .y = notches});
    next_ += 10;
  }

  static constexpr int kWidth = 900, kHeight = 800;
  static constexpr float kTextHeight = 14.0F;
  const Explorer explorer_{.name = "grid", .kind = FieldKind::kScalar, .verbs = {open_volume_verb({})}};
  Vec3 middle_{0.0};
  std::vector<ScriptedEvent> script_;
  int next_ = 4;
  int rest_ = 20;  ///< frames behind the last event
};

TEST_F(GridWindow, TwoPlanesALensAndALengthByMouseAloneAreBackFromTheSession) {
  const std::string tooth = folder_.path("tooth.nhdr").string();
  press("VOLUME");  // folded, or what is below would be out of sight
  press("mode");
  press("plane-widget");
  drag(40.0, -30.0);  // the sphere of the first plane
  scroll(-30.0);
  press("+ plane");
  press("Mark by clicks");
  click(middle_.x - 40.0, middle_.y + 60.0);
  click(middle_.x + 30.0, middle_.y + 80.0);
  press("Stop marking");
  scroll(30.0);
  press("+ lens");
  move(middle_.x - 60.0, middle_.y + 40.0);
  click(middle_.x - 60.0, middle_.y + 50.0);
  scroll(-30.0);
  press("Save session");
  const WindowResult made = open({tooth}, "made");
  ASSERT_TRUE(made.view.volume);
  const VolumeView& volume = *made.view.volume;
  ASSERT_EQ(volume.cuts.size(), 2U);
  EXPECT_LT(glm::dot(volume.cuts[0].kept.outward, Vec3(0.0, 0.0, 1.0)), 0.999) << "it was turned";
  ASSERT_EQ(volume.lenses.size(), 1U);
  const Vec3 lens = center_of(volume.lenses[0].shape, Vec3(0.0));
  const PictureArea area = layout(kWidth, kHeight, kTextHeight).picture;
  const Vec3 seen =
      project(made.view.camera, lens, static_cast<int>(area.width), static_cast<int>(area.height));
  EXPECT_NEAR(seen.x + area.left, middle_.x - 60.0, 1.0) << "where it was left";
  EXPECT_NEAR(seen.y + area.top, middle_.y + 50.0, 1.0);
  ASSERT_EQ(made.message.rfind("saved ", 0), 0U) << made.message;

  // A window of the session, in which nothing is done but to save it again.
  const std::filesystem::path saved = folder_.path("tooth.palpate.toml"), first = folder_.path("first.toml");
  std::filesystem::rename(saved, first);
  script_.clear();
  next_ = 4;
  scroll(-60.0);
  click(73.0, 720.0);
  const WindowResult again = open({"open", "--session", first.string()}, "again");
  EXPECT_EQ(read_file(saved), read_file(first));
  EXPECT_NE(read_file(first).find("annotation = 'length:"), std::string::npos);
  ASSERT_TRUE(again.view.volume);
  EXPECT_EQ(again.view.volume->cuts, volume.cuts);
  ASSERT_EQ(again.view.volume->lenses.size(), 1U);
  EXPECT_EQ(center_of(again.view.volume->lenses[0].shape, Vec3(0.0)), lens);
  EXPECT_EQ(again.view.camera.axes, made.view.camera.axes);
}

// More planes and shapes than are few: the picture of a window, its lists and its session hold all of them.
TEST_F(GridWindow, AsManyPlanesAndShapesAsASessionHolds) {
  constexpr int kCount = 20;
  std::string shapes;
  for (int i = 0; i < kCount; ++i)
    shapes += "halfspace:" + std::to_string(i % 3 - 1) + "," + std::to_string(i) + "," +
              std::to_string(kCount - i) + "," + std::to_string(3000 + i) + ",cut;";
  for (int i = 0; i < kCount; ++i)
    shapes += (i > 0 ? ";sphere:" : "sphere:") + std::to_string(20 + 3 * i) + ",30," +
              std::to_string(40 + 5 * i) + ",8,cut";
  folder_.write("many.toml",
                "format = 1\nprogram = \"grid\"\n[[input]]\nfile = \"tooth.nhdr\"\n[scene]\nlens = \"" +
                    shapes + "\"\nsamples = \"1\"\n");
  at({.kind = InputKind::kKeyDown, .key = 'S', .modifiers = kModifierControl});
  const WindowResult result = open({"open", "--session", folder_.path("many.toml").string()}, "many");
  ASSERT_TRUE(result.view.volume);
  EXPECT_EQ(result.view.volume->cuts.size(), std::size_t{kCount});
  EXPECT_EQ(result.view.volume->lenses.size(), std::size_t{kCount});
  ASSERT_EQ(result.message.rfind("saved ", 0), 0U) << result.message;
  script_.clear();
  next_ = 4;
  const WindowResult again =
      open({"open", "--session", folder_.path("tooth.palpate.toml").string()}, "many_again");
  EXPECT_EQ(again.view.volume->cuts, result.view.volume->cuts);
  EXPECT_EQ(again.view.volume->lenses, result.view.volume->lenses);
}

// In the middle of a drag the picture is that of the function as it has become, in less time than it takes in
// full; and in full once the button is let go.
TEST_F(GridWindow, ThePictureFollowsATransferFunctionWhileItIsDragged) {
  folder_.write(
      "matter.csv",
      "value,red,green,blue,opacity\n0,1,1,1,0\n325,1,1,1,0\n650,1,1,1,0.5\n975,1,1,1,0\n1300,1,1,1,0\n");
  const std::vector<std::string> arguments{folder_.path("tooth.nhdr").string(),
                                           "--transfer-function",
                                           folder_.path("matter.csv").string(),
                                           "--frame-budget",
                                           "1",
                                           "--camera",
                                           "0,0,0,0.5",
                                           "--samples",
                                           "1",
                                           "--shading",
                                           "off"};
  // The third point over the histogram: from half the height of the editor to its foot.
  const auto over = [&](double down) {
    script_.push_back({next_ += 2, {.kind = InputKind::kMove}, "points", 0, 0.5, down});
  };
  over(0.5);
  at({.kind = InputKind::kPress});
  constexpr int kSteps = 8;
  for (int i = 1; i <= kSteps; ++i) over(0.5 + 0.5 * i / kSteps);
  rest_ = 1;
  const WindowResult dragged = open(arguments, "dragged");
  ASSERT_TRUE(dragged.view.volume);
  const auto& points = dragged.view.volume->transfer.points();
  ASSERT_EQ(points.size(), 5U);
  EXPECT_EQ(points[2].opacity, 0.0);
  EXPECT_FALSE(dragged.quality == FrameQuality{}) << "a frame takes more than a millisecond";
  const auto brightness = [](const Image& image) {
    double sum = 0.0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) sum += image.rgba[i];
    return sum / static_cast<double>(image.rgba.size() / 4);
  };
  const auto drawn = [&](double opacity) {
    SceneView view = dragged.view;
    std::vector<ColorPoint> changed = points;
    changed[2].opacity = opacity;
    view.volume->transfer = ColorTransfer(changed);
    const PictureArea area = layout(kWidth, kHeight, kTextHeight).picture;
    return brightness(render_image(view, static_cast<int>(area.width), static_cast<int>(area.height)).image);
  };
  const double before = drawn(0.5), after = drawn(0.0);
  ASSERT_GT(before, after + 1.0) << "the tooth is seen";
  EXPECT_NEAR(brightness(picture()), after, 0.1 * (before - after));

  at({.kind = InputKind::kRelease});
  rest_ = 80;
  const WindowResult rested = open(arguments, "rested");
  EXPECT_EQ(rested.view.volume->transfer.points(), points);
  EXPECT_TRUE(rested.quality == FrameQuality{});
}

// The button held on the grid carries the scene along one axis; let go, view and hand stay where they are.
TEST_F(GridWindow, TheHandCarriesTheViewAlongOneAxisOfTheGrid) {
  const std::string tooth = folder_.path("tooth.nhdr").string();
  move(middle_.x, middle_.y);
  at({.kind = InputKind::kKeyDown, .key = 'G'});
  next_ += 10;
  at({.kind = InputKind::kPress});
  for (int i = 1; i <= 20; ++i) move(middle_.x, middle_.y - 5.0 * i);
  at({.kind = InputKind::kRelease});
  next_ += 20;
  const WindowResult result =
      open({tooth, "--camera", "0,0,0,1", "--focal", "51.2,46.2,80.3", "--grid-detents", "1"}, "carried");
  const Vec3 taken{51.2, 46.2, 80.3};
  const Vec3 moved = result.view.camera.focal_point - taken;
  EXPECT_EQ(moved.x, 0.0);
  EXPECT_EQ(moved.y, 0.0);
  // Up is +z, and the tooth's voxels are one unit high; the scene has gone up with the hand.
  EXPECT_LT(moved.z, -5.0);
  EXPECT_NEAR(moved.z, std::round(moved.z), 1e-9);
  // The hand is on the place that it had taken hold of, within the stretch of a tooth.
  ASSERT_TRUE(result.probe.held);
  EXPECT_LT(glm::distance(result.probe.probe, taken), 15.0);
}

}  // namespace
}  // namespace palpate::test
