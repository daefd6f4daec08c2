// A window that shows a volume in place of lines.
#include <algorithm>
#include <atomic>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "common/compose/view_keep.h"
#include "common/field/analytic/volume_examples.h"
#include "common/field/transfer/color_transfer.h"
#include "common/window/controls/region_control.h"
#include "common/window/panels/panel.h"
#include "common/window/panels/picture_panels.h"
#include "common/window/panels/volume/volume_panel.h"
#include "common/window/window.h"

namespace palpate {
namespace {

/// A built-in volume with two fields, in preset colours.
class VolumeModel : public WindowModel {
 public:
  SceneState start(Progress&) override {
    Document document;
    document.input.field = "scalars";
    return make(document);
  }
  SceneState open(const InputFiles&, Progress& progress) override { return start(progress); }
  SceneState update(const Document& document, Progress&) override {
    ++updated;
    return make(document);
  }
  void keep(const SceneView& view, Document& document) const override {
    keep_camera(view, document);
    if (view.volume) keep_volume(*view.volume, document);
  }
  void close() override {}
  std::string save_session(const Document& document, const std::filesystem::path&) override {
    saved = document;
    return "voxel.toml";
  }

  std::atomic<int> updated{0};
  Document saved;

  static Box bounds() { return image()->bounds(); }

 private:
  static std::shared_ptr<const VolumeImage> image() {
    static const auto voxel = make_volume_image(volume_example("voxel"), kVolumeArray, "voxel");
    return voxel;
  }
  static SceneState make(const Document& document) {
    auto info = std::make_shared<SceneInfo>();
    info->name = "voxel";
    info->fields = {"scalars", "others"};
    info->bounds = bounds();
    info->anatomical = true;
    SceneState scene;
    scene.info = info;
    scene.document = document;
    scene.lines = std::make_shared<const std::vector<Line>>();
    scene.volume =
        VolumeView{.image = image(),
                   .transfer = make_color_transfer(ColorPreset::kDensity, image()->lowest, image()->highest)};
    scene.volume_label = document.input.field;
    return scene;
  }
};

class VolumeWindow : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
    options_.width = 640;
    options_.height = 480;
    options_.frames = 8;
    options_.program = "grid";
    options_.session = "voxel.palpate.toml";
    options_.panels = {draw_volume};
    options_.view.camera.projection = Projection::kOrthographic;
    if (const char* folder = std::getenv("PALPATE_PICTURES")) {
      options_.screenshot =
          std::filesystem::path(folder) /
          (std::string("volume_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".png");
    }
  }

  VolumeModel model_;
  WindowOptions options_;
};

TEST_F(VolumeWindow, ShowsTheVolumeItsSizeAndWhereThePatientLies) {
  const WindowResult result = run_window(model_, options_);
  ASSERT_TRUE(result.view.volume);
  EXPECT_EQ(result.view.volume->image->points, Index3(33));
  EXPECT_EQ(result.view.subtitle, "scalars, 33 x 33 x 33 voxels");
  EXPECT_EQ(result.view.volume_label, "scalars");
  EXPECT_TRUE(result.view.anatomical);
  EXPECT_EQ(result.view.camera.projection, Projection::kOrthographic);
  // As --explain lists it: what this volume takes, and no shader of lenses.
  const auto has = [&](GpuObject::Kind kind, const std::string& what) {
    return std::ranges::any_of(result.gpu, [&](const GpuObject& object) {
      return object.kind == kind && object.what.starts_with(what) &&
             (kind == GpuObject::Kind::kProgram || object.bytes > 0);
    });
  };
  EXPECT_TRUE(has(GpuObject::Kind::kProgram, "volume/volume.frag SHADED"));
  EXPECT_FALSE(has(GpuObject::Kind::kProgram, "volume/lenses.frag"));
  EXPECT_TRUE(has(GpuObject::Kind::kTexture, "voxels"));
}

TEST_F(VolumeWindow, SavesTheViewOfTheVolume) {
  options_.script.push_back({2, {.kind = InputKind::kKeyDown, .key = 'S', .modifiers = kModifierControl}});
  const WindowResult result = run_window(model_, options_);
  EXPECT_EQ(result.message, "saved voxel.toml");
  EXPECT_EQ(model_.saved.volume.samples, VolumeView{}.samples_per_voxel);
}

TEST_F(VolumeWindow, PutsALensUnderTheMouseThatTheWheelMakesLarger) {
  options_.frames = 16;
  options_.script = {{2, {.kind = InputKind::kMove, .x = 460.0, .y = 200.0}},
                     {3, {.kind = InputKind::kKeyDown, .key = 'L'}},
                     {4, {.kind = InputKind::kMove, .x = 480.0, .y = 210.0}},
                     {5, {.kind = InputKind::kWheel, .y = 1.0}},
                     {6, {.kind = InputKind::kPress}},
                     {7, {.kind = InputKind::kRelease}},
                     {8, {.kind = InputKind::kMove, .x = 500.0, .y = 300.0}}};
  const WindowResult result = run_window(model_, options_);
  ASSERT_EQ(result.view.volume->lenses.size(), 1U);
  const ConvexShape& shape = result.view.volume->lenses[0].shape;
  const Vec3 center = center_of(shape, Vec3(0.0));
  // The picture begins right of the panel: project() counts from there.
  const WindowLayout parts = layout(640, 480, 14.0F);
  const Vec3 shown = project(result.view.camera, center, static_cast<int>(parts.picture.width),
                             static_cast<int>(parts.picture.height));
  EXPECT_NEAR(shown.x + parts.picture.left, 480.0, 1.5);
  EXPECT_NEAR(shown.y, 210.0, 1.5);
  EXPECT_GT(clip_line(shape, center, Vec3(1.0, 0.0, 0.0)).last, 1.05 * result.view.bounds.size().x / 6.0);
}

// In the axial slice of four panes, by a click and by the key: what was said of moving it is over with it.
TEST_F(VolumeWindow, SaysNothingMoreOfALensThatWasLeftInASlice) {
  const PictureArea area = layout(640, 480, 14.0F).picture;
  const double x = area.left + 0.25 * area.width, y = area.top + 0.2 * area.height;
  options_.frames = 16;
  options_.script = {{2, {.kind = InputKind::kKeyDown, .key = 'S'}},
                     {3, {.kind = InputKind::kKeyDown, .key = 'S'}},
                     {4, {.kind = InputKind::kMove, .x = x, .y = y}},
                     {5, {.kind = InputKind::kKeyDown, .key = 'L'}},
                     {6, {.kind = InputKind::kMove, .x = x + 9.0, .y = y}}};
  const WindowResult followed = run_window(model_, options_);
  ASSERT_EQ(followed.view.volume->panes.layout, 4);
  EXPECT_NE(followed.message.find("the lens follows the mouse"), std::string::npos) << followed.message;
  options_.script.push_back({8, {.kind = InputKind::kPress}});
  options_.script.push_back({9, {.kind = InputKind::kRelease}});
  const WindowResult left = run_window(model_, options_);
  ASSERT_EQ(left.view.volume->lenses.size(), 1U);
  EXPECT_EQ(left.message, "");
  // It stays there.
  options_.script.push_back({11, {.kind = InputKind::kMove, .x = x + 30.0, .y = y + 20.0}});
  const WindowResult away = run_window(model_, options_);
  EXPECT_EQ(away.view.volume->lenses.at(0).shape, left.view.volume->lenses.at(0).shape);
}

// The dot on the upper face along x, dragged by the mouse; then Ctrl+S, and in another window Ctrl+Z.
TEST_F(VolumeWindow, DragsAFaceOfTheRegionSavesItAndTakesItBack) {
  const Box bounds = model_.bounds(), box = new_region(bounds);
  options_.region = box;
  options_.frames = 20;
  const WindowLayout parts = layout(640, 480, 14.0F);
  const auto width = static_cast<int>(parts.picture.width), height = static_cast<int>(parts.picture.height);
  const Camera camera = make_camera(bounds, options_.angles, parts.picture.width / parts.picture.height,
                                    Projection::kOrthographic);
  const auto shown = [&](double x) {
    Vec3 at = box.center();
    at.x = x;
    return project(camera, at, width, height) + Vec3(parts.picture.left, parts.picture.top, 0.0);
  };
  const double wanted = box.upper.x + 0.125 * bounds.size().x;
  const Vec3 from = shown(box.upper.x), to = shown(wanted);
  options_.script = {{2, {.kind = InputKind::kMove, .x = from.x, .y = from.y}},
                     {4, {.kind = InputKind::kPress}},
                     {6, {.kind = InputKind::kMove, .x = to.x, .y = to.y}},
                     {8, {.kind = InputKind::kRelease}},
                     {10, {.kind = InputKind::kKeyDown, .key = 'S', .modifiers = kModifierControl}}};
  const WindowResult dragged = run_window(model_, options_);
  ASSERT_TRUE(dragged.region);
  EXPECT_NEAR(dragged.region->upper.x, wanted, 1e-9 * bounds.diagonal());
  EXPECT_EQ(dragged.region->lower, box.lower);
  EXPECT_EQ(dragged.view.camera.axes, camera.axes);  // it has not turned the view
  EXPECT_EQ(model_.saved.slice.box, box_text(*dragged.region));
  options_.script.push_back({12, {.kind = InputKind::kKeyDown, .key = 'Z', .modifiers = kModifierControl}});
  const WindowResult undone = run_window(model_, options_);
  ASSERT_TRUE(undone.region);
  EXPECT_EQ(undone.region->upper, box.upper);
}

// The fourth of the preset's points, dragged up in the editor: an own function, which the model is asked for.
TEST_F(VolumeWindow, EditsTheTransferFunctionOverTheHistogram) {
  options_.frames = 20;
  const ColorTransfer preset = make_color_transfer(ColorPreset::kDensity, 0.0, 255.0);
  const ColorPoint& fourth = preset.points()[3];
  const double across = fourth.value / 255.0, down = 1.0 - fourth.opacity;
  options_.script = {{3, {.kind = InputKind::kMove}, "points", 0, across, down},
                     {5, {.kind = InputKind::kPress}},
                     {6, {.kind = InputKind::kMove}, "points", 0, across + 0.01, 0.5 * down},
                     {7, {.kind = InputKind::kMove}, "points", 0, across + 0.02, 0.1},
                     {9, {.kind = InputKind::kRelease}}};
  const WindowResult result = run_window(model_, options_);
  EXPECT_TRUE(result.document.volume.transfer.starts_with("points:")) << result.document.volume.transfer;
  EXPECT_GT(model_.updated, 0);
  const auto edited = transfer_from_text(result.document.volume.transfer);
  ASSERT_TRUE(edited);
  EXPECT_TRUE(result.missing.empty());
  ASSERT_EQ(edited->points().size(), preset.points().size());
  EXPECT_GT(edited->points()[3].opacity, preset.points()[3].opacity + 0.3);
  EXPECT_EQ(edited->points()[2], preset.points()[2]);
}

TEST(SizeText, CountsLinesOrVoxels) {
  SceneState scene;
  scene.lines = std::make_shared<const std::vector<Line>>(3);
  EXPECT_EQ(size_text(scene), "3 lines");
  scene.volume.emplace();
  scene.volume->image = make_volume_image(volume_example("marschner-lobb"), kVolumeArray, "");
  EXPECT_EQ(size_text(scene), "41 x 41 x 41 voxels");
}

}  // namespace
}  // namespace palpate
