// A hand in the window of cardiac, led by mouse and wheel alone: the layer that is shown is the one that it
// is on, and the verb `probe` repeats its run to the bit.
#include "common/window/window.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "apps/cardiac/cardiac_model.h"
#include "common/field/layer/paint_surfaces.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/window/panels/panel.h"
#include "tests/e2e/explorer_test.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

/// The depth of the layer that is shown.
double layer_of(const WindowResult& result) { return std::atof(result.document.heart.layer.c_str()); }

double distance_to(const Vec3& x, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double square = glm::dot(along, along);
  const double part = square > 0.0 ? std::clamp(glm::dot(x - a, along) / square, 0.0, 1.0) : 0.0;
  return glm::distance(x, a + part * along);
}

class CardiacWindow : public ExplorerTest {
 protected:
  CardiacWindow() : ExplorerTest("cardiac") {
    options_.common.threads = 1;
    options_.input.example = "ventricle";
    options_.tracing.seeds = "random:30";
    options_.heart.layer = "0.5";
    window_.program = "cardiac";
    window_.width = kWidth;
    window_.height = kHeight;
    window_.picture_folder = folder_.path();
    window_.panels = cardiac_panels();
    window_.touch.modes = modes_of(FieldKind::kFibre);
    window_.touch.threads = 1;
    window_.touch.record = folder_.path("run.txt");
    window_.touch.recorded.program = "cardiac";
    window_.touch.recorded.values.emplace_back("example", "ventricle");
    if (const char* folder = std::getenv("PALPATE_PICTURES"))
      window_.screenshot = std::filesystem::path(folder) / "cardiac_window.png";
  }
  void SetUp() override {
    if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
  }

  /// On the wall, left of the middle of the picture.
  void grab(const char* mode) {
    for (std::size_t m = 0; m < window_.touch.modes.size(); ++m)
      if (window_.touch.modes[m].name == mode) window_.touch.choice.mode = m;
    constexpr float kTextHeight = 14.0F;
    const PictureArea area = layout(kWidth, kHeight, kTextHeight).picture;
    at(1, {.kind = InputKind::kMove, .x = area.left + 0.5 * area.width, .y = 0.55 * area.height});
    at(10, {.kind = InputKind::kKeyDown, .key = 'G'});
    at(11, {.kind = InputKind::kKeyUp, .key = 'G'});
  }
  void at(int frame, InputEvent event) { window_.script.push_back({frame, std::move(event)}); }
  WindowResult run_until(int frame) {
    window_.frames = frame;
    window_.patience = 60.0;
    CardiacModel model(options_, "cardiac");
    return run_window(model, window_);
  }

  static constexpr int kWidth = 800, kHeight = 640;
  Document options_;
  WindowOptions window_;
};

TEST_F(CardiacWindow, ShowsTheLayerThatTheHandIsOnAndProbeRepeatsIt) {
  grab("layer");
  for (int notch = 0; notch < 2; ++notch)
    at(60 + 20 * notch, {.kind = InputKind::kWheel, .y = 1.0});  // through the wall, along the view
  const WindowResult result = run_until(240);
  ASSERT_TRUE(result.probe.held);
  EXPECT_EQ(result.probe.state, HoldState::kHeld);
  EXPECT_LT(layer_of(result), 0.5) << "it came from the layer that was shown, pushed inwards";
  ASSERT_TRUE(result.probe.scalar);
  EXPECT_NEAR(*result.probe.scalar, layer_of(result), 1e-9) << "what is seen is what is felt";
  EXPECT_NEAR(8.0 * layer_of(result), std::round(8.0 * layer_of(result)), 1e-9) << "one of seven";
  ASSERT_EQ(result.view.surfaces.size(), 1U);
  EXPECT_EQ(result.view.surfaces[0].mesh->level, layer_of(result));
  ASSERT_TRUE(result.view.surfaces[0].values);
  EXPECT_EQ(result.view.surfaces[0].values->size(), result.view.surfaces[0].mesh->points.size());

  const Json summary = json({"probe", "--example", "ventricle", "--replay", "run.txt", "--out", "log.csv"});
  EXPECT_NE(summary["replay"].get<std::string>().find("identical"), std::string::npos) << summary["replay"];
  std::istringstream log(read_file(folder_.path("log.csv")));
  std::string row, last;
  while (std::getline(log, row))
    if (row.find(",held,") != std::string::npos) last = row;
  std::vector<double> numbers;
  std::istringstream fields(last);
  for (std::string field; std::getline(fields, field, ',');) numbers.push_back(std::atof(field.c_str()));
  ASSERT_GT(numbers.size(), 6U);
  EXPECT_NEAR(glm::distance(Vec3{numbers[4], numbers[5], numbers[6]}, result.probe.proxy), 0.0, 1e-9);
}

// A shell has no layers: it is drawn with its values, and the hand that held a heart before holds nothing.
TEST_F(CardiacWindow, ShowsAShellInPlaceOfAHeartAndLetsGo) {
  std::ofstream(folder_.path("a.pts")) << "4\n0 0 0\n20000 0 0\n20000 10000 0\n0 10000 5000\n";
  std::ofstream(folder_.path("a.elem")) << "2\nTr 0 1 2 7\nTr 0 2 3 8\n";
  std::ofstream(folder_.path("a.lon")) << "1\n1 0 0\n0 1 0\n";
  grab("layer");
  at(60, {.kind = InputKind::kDrop, .files = {folder_.path("a.elem").string()}});
  at(160, {.kind = InputKind::kKeyDown, .key = 'G'});
  at(161, {.kind = InputKind::kKeyUp, .key = 'G'});
  const WindowResult result = run_until(200);
  EXPECT_FALSE(result.probe.held);
  ASSERT_EQ(result.view.surfaces.size(), 1U);
  EXPECT_EQ(result.view.surfaces[0].mesh->triangles.size(), 2U);
  EXPECT_EQ(*result.view.surfaces[0].values, (std::vector<float>{7, 7, 7, 8, 8, 8}));
  EXPECT_EQ(result.view.lines->size(), 2U);
  EXPECT_EQ(result.document.heart.angle, "region");
  EXPECT_EQ(result.document.heart.layer, "");
}

// A brush corrects what the wall was taken for: a stroke is one edit, the view does not turn, and layers are solved anew.
TEST_F(CardiacWindow, PaintsTheWallWithABrush) {
  options_.heart.walls = "found";
  constexpr float kTextHeight = 14.0F;
  constexpr int kTall = 2000;  // the panel whole
  window_.height = kTall;
  window_.hidden = true;  // a screen is lower
  const PictureArea area = layout(kWidth, kTall, kTextHeight).picture;
  const auto press = [&](int frame, const std::string& control) {
    window_.script.push_back({frame, {.kind = InputKind::kMove}, control});
    at(frame + 2, {.kind = InputKind::kPress, .button = MouseButton::kLeft});
    at(frame + 4, {.kind = InputKind::kRelease, .button = MouseButton::kLeft});
  };
  press(20, "base");
  const double x = area.left + 0.5 * area.width, y = area.top + 0.55 * area.height;
  at(30, {.kind = InputKind::kMove, .x = x, .y = y});
  at(34, {.kind = InputKind::kPress, .button = MouseButton::kLeft});
  at(40, {.kind = InputKind::kMove, .x = x + 60.0, .y = y});
  at(46, {.kind = InputKind::kRelease, .button = MouseButton::kLeft});
  const WindowResult result = run_until(140);
  EXPECT_EQ(result.missing, std::vector<std::string>());
  ASSERT_GE(result.document.input.paint.size(), 2U) << "where it began and where it ended";
  const std::vector<SurfacePaint> paint = parse_paint(result.document.input.paint);
  EXPECT_EQ(paint.front().role, BorderRole::kBase);
  const Vec3 seen = project(result.view.camera, paint.front().center, static_cast<int>(area.width),
                            static_cast<int>(area.height));
  EXPECT_LT(std::hypot(seen.x + area.left - x, seen.y + area.top - y), 1.5)
      << "[pixels], under the mouse still";
}

/// The measured ventricles of a dog, from the file to a fibre under the hand, by the mouse alone.
class CardiacDog : public CardiacWindow {
 protected:
  void SetUp() override {
    CardiacWindow::SetUp();
    PALPATE_NEED_DATA(nodes, "cardiac/canine-heart/heart.exnode.gz");
    for (const char* name : {"heart.exnode.gz", "heart.exelem.gz"})
      std::filesystem::copy_file(nodes.parent_path() / name, folder_.path(name));
    options_.input.example.clear();
    options_.input.files = {folder_.path("heart.exnode.gz")};
    options_.tracing.seeds = "random:200";
    window_.touch.recorded.values.clear();
    window_.touch.choice.mode = 2;  // friction: another one is chosen below
    // The servo has the time between two frames that a user would give it.
    window_.stop_requested = [] {
      std::this_thread::sleep_for(std::chrono::milliseconds(8));
      return false;
    };
    constexpr float kTextHeight = 14.0F;
    area_ = layout(kWidth, kHeight, kTextHeight).picture;
  }

  void move(int frame, double x, double y) { at(frame, {.kind = InputKind::kMove, .x = x, .y = y}); }
  void button(int frame, InputKind kind) { at(frame, {.kind = kind, .button = MouseButton::kLeft}); }
  /// A control of the panel, by its label.
  void press(int frame, const std::string& control) {
    window_.script.push_back({frame, {.kind = InputKind::kMove}, control});
    button(frame + 2, InputKind::kPress);
    button(frame + 4, InputKind::kRelease);
  }
  /// Chooses the mode and asks for the probe in the panel, and presses on the wall.
  void grab_by_mouse(const std::string& mode) {
    press(4, "mode");  // once the panel has been drawn
    press(12, mode);
    press(20, "Grab");
    move(30, area_.left + kStartX * area_.width, area_.top + kStartY * area_.height);
    button(34, InputKind::kPress);
  }
  static constexpr int kGrabbed = 60;  // frame
  static constexpr double kStartX = 0.45, kStartY = 0.5;

  PictureArea area_;
};

TEST_F(CardiacDog, IsFollowedAlongAFibreByTheMouseAlone) {
  grab_by_mouse("fibre");
  window_.touch.record.clear();
  const WindowResult start = run_until(kGrabbed);
  ASSERT_TRUE(start.probe.held) << start.message;
  ASSERT_EQ(start.probe.state, HoldState::kHeld);
  EXPECT_NEAR(layer_of(start), 0.5, 1e-12) << "the layer that was seen";

  // The fibre there, traced by another method, and where it is seen.
  const Vec3& seed = start.probe.proxy;
  std::ostringstream place;
  place.precision(17);
  place << "point:" << seed.x << "," << seed.y << "," << seed.z;
  (void)json({"trace", "heart.exnode.gz", "--layer", "0.5", "--seeds", place.str(), "--max-length", "30",
              "--direction", "forward", "--out", "fibre.csv"});
  std::vector<Vec3> fibre;
  std::istringstream rows(read_file(folder_.path("fibre.csv")));
  std::string row;
  std::getline(rows, row);
  while (std::getline(rows, row)) {
    std::istringstream fields(row);
    std::vector<double> numbers;
    for (std::string field; std::getline(fields, field, ',');) numbers.push_back(std::atof(field.c_str()));
    fibre.emplace_back(numbers[3], numbers[4], numbers[5]);
  }
  ASSERT_GT(fibre.size(), 20U);

  // The hand goes along it, to either side of it in turn by less than it takes to the next fibre.
  // A quick hand: far enough at once that the plane of the view would lead it through several layers.
  constexpr int kSteps = 20, kRest = 8;
  constexpr double kAside = 3.0;  // [pixels]
  for (int n = 1; n <= kSteps; ++n) {
    const std::size_t i = (fibre.size() - 1) * static_cast<std::size_t>(n) / kSteps;
    const Vec3 shown =
        project(start.view.camera, fibre[i], static_cast<int>(area_.width), static_cast<int>(area_.height));
    const double aside = kAside * std::sin(2.0 * n);
    move(kGrabbed + kRest * n, area_.left + shown.x + 0.7 * aside, area_.top + shown.y + 0.7 * aside);
  }
  window_.touch.record = folder_.path("run.txt");
  window_.picture_folder = folder_.path();
  constexpr int kThere = kGrabbed + kRest * kSteps + 20;
  at(kThere, {.kind = InputKind::kKeyDown, .key = 'K'});
  at(kThere + 1, {.kind = InputKind::kKeyUp, .key = 'K'});
  at(kThere + 10, {.kind = InputKind::kKeyDown, .key = 'E', .modifiers = kModifierControl});
  at(kThere + 11, {.kind = InputKind::kKeyUp, .key = 'E', .modifiers = kModifierControl});
  const WindowResult result = run_until(kThere + 20);
  EXPECT_EQ(result.probe.state, HoldState::kHeld);
  // What was followed is kept with its force, and saved.
  EXPECT_NE(result.log.find("kept line 1"), std::string::npos) << result.log;
  ASSERT_TRUE(result.view.probe->drawn_lines);
  EXPECT_EQ(result.view.probe->drawn_lines->size(), 1U);
  EXPECT_NE(read_file(folder_.path("followed.vtp")).find("\"force\""), std::string::npos) << result.log;
  EXPECT_EQ(result.probe.popped, 0) << "it stays on its layer, around the wall";
  EXPECT_NEAR(layer_of(result), 0.5, 1e-12);
  EXPECT_LT(glm::distance(result.probe.proxy, fibre.back()), 3.0)
      << "[mm]; 30 along the fibre from where it began";

  // Every place that was felt is on the fibre, by the log of the same run.
  const Json summary = json({"probe", "heart.exnode.gz", "--replay", "run.txt", "--out", "log.csv"});
  EXPECT_NE(summary["replay"].get<std::string>().find("identical"), std::string::npos) << summary["replay"];
  std::istringstream log(read_file(folder_.path("log.csv")));
  double farthest = 0.0;
  int held = 0;
  while (std::getline(log, row)) {
    if (row.find(",held,") == std::string::npos) continue;
    std::istringstream fields(row);
    std::vector<double> numbers;
    for (std::string field; std::getline(fields, field, ',');) numbers.push_back(std::atof(field.c_str()));
    const Vec3 felt{numbers[4], numbers[5], numbers[6]};
    double nearest = HUGE_VAL;
    for (std::size_t i = 1; i < fibre.size(); ++i)
      nearest = std::min(nearest, distance_to(felt, fibre[i - 1], fibre[i]));
    farthest = std::max(farthest, nearest);
    ++held;
  }
  EXPECT_GT(held, 500);
  EXPECT_LT(farthest, 0.5) << "[mm], of a heart of 100 mm; the mouse was three pixels, 0.6 mm, beside it";
}

TEST_F(CardiacDog, KeepsItsLayerUnderTheMouseAroundTheWall) {
  grab_by_mouse("layer");
  // To the contour of the heart on the right in a few large steps, each of which the plane of the view would
  // take off the layer.
  constexpr int kSteps = 6, kRest = 12;
  constexpr double kEndX = 0.66;  // the contour of the middle layer is within that of the wall
  double x = 0.0;
  const double y = area_.top + kStartY * area_.height;
  for (int n = 1; n <= kSteps; ++n) {
    x = area_.left + (kStartX + (kEndX - kStartX) * n / kSteps) * area_.width;
    move(kGrabbed + kRest * n, x, y);
  }
  const WindowResult result = run_until(kGrabbed + kRest * (kSteps + 2));
  EXPECT_EQ(result.missing, std::vector<std::string>());
  EXPECT_EQ(result.document.touch.mode, "layer");
  EXPECT_EQ(result.probe.state, HoldState::kHeld);
  EXPECT_EQ(result.probe.popped, 0);
  EXPECT_NEAR(layer_of(result), 0.5, 1e-12);
  EXPECT_LT(result.probe.stretch, 0.2) << "[mm]: nothing pulls it off the wall";
  const Vec3 shown = project(result.view.camera, result.probe.proxy, static_cast<int>(area_.width),
                             static_cast<int>(area_.height));
  EXPECT_LT(std::hypot(area_.left + shown.x - x, area_.top + shown.y - y), 1.0) << "[pixels]";
}

}  // namespace
}  // namespace palpate::test
