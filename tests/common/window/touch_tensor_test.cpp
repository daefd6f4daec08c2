// Tracts drawn by hand in the window, with the mouse alone: the panel's button, then drags over a slice.

#include <cmath>

#include "apps/dtmri/dtmri_model.h"
#include "common/field/tensor/diffusion_measures.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/math/symmetric3.h"
#include "common/window/files/saved_files.h"
#include "tests/common/render/tensor/sample_tensors.h"
#include "tests/common/window/touch_window.h"

namespace palpate::test {
namespace {

/// A bundle along x, seen from above.
class BundleModel final : public WindowModel {
 public:
  SceneState start(Progress&) override {
    Document document;
    document.input.field = kField;
    return make(document);
  }
  SceneState open(const InputFiles&, Progress& progress) override { return start(progress); }
  SceneState update(const Document& document, Progress&) override { return make(document); }
  void keep(const SceneView& view, Document& document) const override { keep_camera(view, document); }
  void close() override {}
  std::string save_session(const Document& document, const std::filesystem::path&) override {
    return settings_text(document);
  }

 private:
  static constexpr const char* kField = "D";

  static SceneState make(const Document& document) {
    static const auto voxels = sampled_tensors(centred_lattice(Index3{21}, Mat3{4.0}), [](const Vec3&) {
      return linear_tensor({1.0, 0.0, 0.0});
    });
    auto info = std::make_shared<SceneInfo>();
    info->name = "bundle";
    info->fields = {kField};
    info->bounds = voxels->bounds();
    SceneState scene{.info = info, .document = document};
    scene.lines = std::make_shared<const std::vector<Line>>();
    scene.tensors = TensorView{.image = voxels, .position = info->bounds.center()};
    scene.tensors->slices = {false, false, true};
    return scene;
  }
};

class TouchTensor : public TouchWindowTest {
 protected:
  void SetUp() override {
    TouchWindowTest::SetUp();
    options_.panels = dtmri_panels();
    options_.touch.modes = modes_of(FieldKind::kTensor);
    options_.angles = {.azimuth = 0.0, .elevation = 90.0};
  }
  WindowResult run() { return run_model(model_); }
  void draw_button() { press("Draw tracts"); }
  /// A stroke with the button down, from one place to another [pixels from the middle].
  void stroke(double from_x, double from_y, double to_x, double to_y) {
    constexpr int kSteps = 24;
    const int begin = next();
    move_by(begin, from_x, from_y);
    at(begin + 1, {.kind = InputKind::kPress});
    for (int i = 1; i <= kSteps; ++i) {
      const double u = static_cast<double>(i) / kSteps;
      move_by(begin + 2 + i, from_x + u * (to_x - from_x), from_y + u * (to_y - from_y));
    }
    at(begin + kSteps + 8, {.kind = InputKind::kRelease});
  }
  static std::size_t kept(const WindowResult& result) {
    return result.view.probe && result.view.probe->drawn_lines ? result.view.probe->drawn_lines->size() : 0;
  }
  static const Line& tract(const WindowResult& result) {
    return *result.view.probe->drawn_lines->front().line;
  }

  BundleModel model_;
};

TEST_F(TouchTensor, ADragDrawsATractThatFollowsTheBundleAndNotTheMouse) {
  draw_button();
  stroke(-120.0, 0.0, 120.0, 8.0);
  key('K');
  const WindowResult result = run();
  ASSERT_EQ(kept(result), 1U) << result.message;
  const Line& line = tract(result);
  ASSERT_GT(line.points.size(), 20U);
  const Vec3 way = line.points.back().position - line.points.front().position;
  EXPECT_GT(way.x, 20.0);
  // The mouse went 8 pixels aside for 240 along: the hold across the bundle gives only farther out.
  EXPECT_LT(std::abs(way.y), 0.02 * way.x);
  EXPECT_FALSE(result.probe.held) << "a stroke ends with its button";
}

TEST_F(TouchTensor, TheProbeReadsTheTensorWhoseGlyphIsDrawnThere) {
  grab();
  const WindowResult result = run();
  ASSERT_TRUE(result.probe.held);
  ASSERT_TRUE(result.probe.tensor);
  const SymmetricEigen eigen = symmetric_eigen(*result.probe.tensor);
  EXPECT_NEAR(std::abs(eigen.vectors[0].x), 1.0, 1e-3);
  EXPECT_GT(anisotropy(eigen.values).linear, 0.5);
  ASSERT_TRUE(result.view.probe->tensor);
  EXPECT_EQ(*result.view.probe->tensor, *result.probe.tensor);
  EXPECT_EQ(result.probe.popped, 0);
}

TEST_F(TouchTensor, AStrokeGoesOnFromTheEndThatItBeginsAt) {
  draw_button();
  stroke(-20.0, 0.0, 60.0, 0.0);
  stroke(-20.0, 0.0, -100.0, 0.0);
  key('K');
  const WindowResult result = run();
  ASSERT_EQ(kept(result), 1U);
  const Line& line = tract(result);
  EXPECT_LT(line.points.front().position.x, line.points.back().position.x) << "as its first stroke went";
  double arc = -1.0;
  for (const LinePoint& point : line.points) {
    EXPECT_GT(point.arc, arc);
    arc = point.arc;
  }
  EXPECT_NEAR(arc, glm::distance(line.points.front().position, line.points.back().position), 0.1 * arc);
}

TEST_F(TouchTensor, StrokesAreTakenBackOneByOneAndReplaced) {
  options_.touch.choice.stroke = StrokeUse::kReplace;
  draw_button();
  stroke(-100.0, 0.0, -40.0, 0.0);
  stroke(40.0, 0.0, 100.0, 0.0);
  key('Z', kModifierControl);
  key('K');
  const WindowResult result = run();
  ASSERT_EQ(kept(result), 1U) << result.message;
  EXPECT_LT(tract(result).points.back().position.x, 0.0) << "the first stroke is back";
}

TEST_F(TouchTensor, TheButtonsKeepUndoAndSave) {
  draw_button();
  stroke(-100.0, 0.0, 100.0, 0.0);
  press("Keep tract");
  press("Undo");  // not kept any more, but still drawn
  key('E', kModifierControl);
  const WindowResult result = run();
  EXPECT_EQ(kept(result), 1U) << "saving keeps what is drawn";
  EXPECT_NE(result.message.find("tracts.tck"), std::string::npos) << result.message;
  EXPECT_TRUE(std::filesystem::exists(folder_.path("tracts.tck")));
}

TEST_F(TouchTensor, AStrokeGoesOnFromAnEndThatIsSeenBehindTheSlice) {
  constexpr int kDown = 264;
  draw_button();
  stroke(-100.0, 0.0, 0.0, 0.0);
  for (int i = 0; i < 4; ++i) key(kDown);
  stroke(-1.0, 1.0, 90.0, 0.0);
  key('K');
  const WindowResult result = run();
  ASSERT_EQ(kept(result), 1U) << result.message;
  EXPECT_GT(tract(result).points.back().position.x, 10.0);
}

TEST_F(TouchTensor, ThePanelStaysInPlaceHoweverManyTractsAreKept) {
  grow_to(1000);
  press("##shown");
  EXPECT_TRUE(run().view.tensors->slices[0]) << "where the box is without tracts";
  options_.script.clear();
  last_ = 0;
  draw_button();
  constexpr int kMany = 4;
  for (int i = 0; i < kMany; ++i) {
    stroke(-40.0, 30.0 * i, 40.0, 30.0 * i);
    press("Keep tract");
  }
  press("##shown");
  const WindowResult result = run();
  EXPECT_EQ(kept(result), static_cast<std::size_t>(kMany));
  EXPECT_TRUE(result.view.tensors->slices[0]);
}

TEST_F(TouchTensor, TheReadOutUnderTheMouseGoesWithIt) {
  move_by(next(), 90.0, 40.0);
  last_ += kPause;
  const WindowResult plain = run();
  ASSERT_TRUE(plain.tensor);
  options_.script.clear();
  last_ = 0;
  grab();
  lead_to(90.0, 40.0);
  key('G');
  last_ += kPause;
  const WindowResult after = run();
  ASSERT_TRUE(after.tensor);
  EXPECT_EQ(after.tensor->voxel, plain.tensor->voxel);
}

TEST_F(TouchTensor, AsksBeforeTractsAreLost) {
  draw_button();
  stroke(-100.0, 0.0, 100.0, 0.0);
  key('Q');
  key('Z', kModifierControl);  // not for the picture now
  WindowResult result = run();
  EXPECT_EQ(result.frames, options_.frames) << "asked";
  key(kEscape);
  key('K');
  options_.screenshot.clear();
  result = run();
  EXPECT_EQ(result.frames, options_.frames) << "cancelled";
  EXPECT_EQ(kept(result), 1U) << "the stroke is still there";
  EXPECT_FALSE(std::filesystem::exists(folder_.path("tracts.tck")));

  const auto script = options_.script;
  key('Q');
  key('D');
  last_ += kPause;
  result = run();
  EXPECT_LT(result.frames, options_.frames) << "discarded";
  EXPECT_FALSE(std::filesystem::exists(folder_.path("tracts.tck")));

  options_.script = script;
  key('Q');
  key('S');
  last_ += kPause;
  result = run();
  EXPECT_LT(result.frames, options_.frames) << "saved";
  EXPECT_TRUE(std::filesystem::exists(folder_.path("tracts.tck")));
}

TEST_F(TouchTensor, ClosesUnaskedWhenAllIsSaved) {
  draw_button();
  stroke(-100.0, 0.0, 100.0, 0.0);
  key('E', kModifierControl);
  key('Q');
  last_ += 4 * kPause;
  EXPECT_LT(run().frames, options_.frames);
}

void keep_one(DrawnLines& lines, double x) {
  Line line;
  line.points = {{.position = {x, 0.0, 0.0}}, {.position = {x + 1.0, 0.0, 0.0}, .arc = 1.0}};
  lines.keep(line, {1.0, 2.0});
}

TEST(SavedFiles, NeverLoseASavedTract) {
  const TempFolder folder;
  SavedFiles files(folder.path(), "test");
  DrawnLines lines;
  std::string name = "tracts.csv";
  keep_one(lines, 0.0);
  EXPECT_EQ(files.unsaved(lines), 1U);
  EXPECT_EQ(files.save_lines(lines, name).filename(), "tracts.csv");
  EXPECT_EQ(files.unsaved(lines), 0U);
  keep_one(lines, 10.0);
  EXPECT_EQ(files.unsaved(lines), 1U);
  EXPECT_EQ(files.save_lines(lines, name).filename(), "tracts.csv") << "all that is in it is in it again";

  // One that was saved is deleted: the file that has it stays.
  const std::string before = read_file(folder.path("tracts.csv"));
  lines.remove(0);
  keep_one(lines, 20.0);
  EXPECT_EQ(files.save_lines(lines, name).filename(), "tracts-2.csv");
  EXPECT_EQ(name, "tracts-2.csv");
  EXPECT_EQ(read_file(folder.path("tracts.csv")), before);
  keep_one(lines, 30.0);
  EXPECT_EQ(files.save_lines(lines, name).filename(), "tracts-2.csv");
  lines.clear();
  keep_one(lines, 40.0);
  EXPECT_EQ(files.save_lines(lines, name).filename(), "tracts-3.csv") << "and not tracts-2-2";
}

TEST_F(TouchTensor, AClearedDrawingComesBack) {
  grow_to(1000);
  press("TENSORS");  // folded, or what is below would be out of sight
  press("TRACTS");
  draw_button();
  stroke(-100.0, 0.0, 100.0, 0.0);
  press("Clear drawing");
  key('Z', kModifierControl);  // that, and not the stroke
  key('K');
  EXPECT_EQ(kept(run()), 1U);
}

TEST_F(TouchTensor, TheSessionHoldsWhatTheProgramTakes) {
  key('2');
  key('S', kModifierControl);
  const std::string saved = run().message;
  EXPECT_NE(saved.find("mode=anisotropy-point"), std::string::npos) << saved;
  EXPECT_NE(saved.find("anisotropy-curve=0:0,1:8"), std::string::npos) << saved;
  EXPECT_EQ(saved.find("stroke="), std::string::npos) << "as a new document has it: " << saved;
  EXPECT_EQ(saved.find("release="), std::string::npos) << saved;
}

}  // namespace
}  // namespace palpate::test
