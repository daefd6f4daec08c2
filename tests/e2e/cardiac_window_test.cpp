// A hand in the window of cardiac, led by mouse and wheel alone: the layer that is shown is the one that it
// is on, and the verb `probe` repeats its run to the bit.
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "apps/cardiac/cardiac_model.h"
#include "apps/cardiac/cardiac_modes.h"
#include "common/app/window/panel.h"
#include "common/app/window/shown_scene.h"
#include "common/app/window/window.h"
#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

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
    window_.touch.modes = cardiac_modes();
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
    CardiacModel model(options_, "cardiac");
    return run_window(model, window_);
  }

  static constexpr int kWidth = 800, kHeight = 640;
  Options options_;
  WindowOptions window_;
};

TEST_F(CardiacWindow, ShowsTheLayerThatTheHandIsOnAndProbeRepeatsIt) {
  grab("layer");
  for (int notch = 0; notch < 4; ++notch)
    at(60 + 20 * notch, {.kind = InputKind::kWheel, .y = 1.0});  // through the wall, along the view
  const WindowResult result = run_until(240);
  ASSERT_TRUE(result.probe.held);
  EXPECT_EQ(result.probe.state, HoldState::kHeld);
  EXPECT_LT(result.settings.layer, 0.5) << "it came from the outer surface, through the layer that was shown";
  ASSERT_TRUE(result.probe.scalar);
  EXPECT_NEAR(*result.probe.scalar, result.settings.layer, 1e-9) << "what is seen is what is felt";
  EXPECT_NEAR(8.0 * result.settings.layer, std::round(8.0 * result.settings.layer), 1e-9) << "one of seven";
  ASSERT_EQ(result.view.surfaces.size(), 1U);
  EXPECT_EQ(result.view.surfaces[0].mesh->level, result.settings.layer);
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

/// What the window asks of the program, without a window.
class CardiacColors : public ::testing::Test {
 protected:
  CardiacColors() {
    options_.common.threads = 1;
    options_.input.example = "wave";
    options_.tracing.seeds = "random:30";
    options_.heart.angle = "potential";
  }
  /// At a time step; nothing: at the start.
  ValueRange range_at(CardiacModel& model, std::optional<std::size_t> step) {
    Progress progress;
    if (step) settings_.time_step = *step;
    const SceneState state = step ? model.update(settings_, progress) : model.start(progress);
    settings_ = state.settings;
    SceneView view;
    show_scene(state, !step, view);
    return value_range(*view.lines, view.style);
  }

  Options options_;
  SceneSettings settings_;
};

TEST_F(CardiacColors, KeepTheirRangeWhileTheSeriesPlays) {
  CardiacModel model(options_, "cardiac");
  const ValueRange first = range_at(model, std::nullopt);
  EXPECT_LT(first.lower, -75.0) << "at rest, as all is at the start";
  EXPECT_GT(first.upper, 0.0) << "excited, as nothing is yet";
  for (const std::size_t step : {3U, 20U, 40U, 60U, 80U, 0U}) EXPECT_EQ(range_at(model, step), first) << step;
}

TEST_F(CardiacColors, HaveTheRangeThatIsAskedFor) {
  options_.heart.range = "0.25,0.5";
  options_.heart.angle = "depth";
  options_.input.example = "ventricle";
  CardiacModel model(options_, "cardiac");
  EXPECT_EQ(range_at(model, std::nullopt), (ValueRange{0.25, 0.5}));
}

TEST_F(CardiacColors, OfAnglesGoAllTheWayRoundAlsoComingBackToThem) {
  options_.heart.angle = "helix";
  options_.input.example = "ventricle";
  CardiacModel model(options_, "cardiac");
  const ValueRange all{-90.0, 90.0};
  EXPECT_EQ(range_at(model, std::nullopt), all);
  settings_.color_array = "depth";
  EXPECT_FALSE(range_at(model, 0) == all);
  settings_.color_array = "helix";
  EXPECT_EQ(range_at(model, 0), all);
}

}  // namespace
}  // namespace palpate::test
