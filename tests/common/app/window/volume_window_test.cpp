// A window that shows a volume in place of lines.
#include <atomic>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "common/app/window/panel.h"
#include "common/app/window/window.h"
#include "common/field/analytic/volume_examples.h"

namespace palpate {
namespace {

/// A built-in volume with two fields, in preset colours.
class VolumeModel : public WindowModel {
 public:
  SceneState start(Progress&) override {
    SceneSettings settings;
    settings.field = "scalars";
    return make(settings);
  }
  SceneState open(const InputFiles&, Progress& progress) override { return start(progress); }
  SceneState update(const SceneSettings& settings, Progress&) override {
    ++updated;
    return make(settings);
  }
  std::string save_session(const SceneSettings&, const SceneView& view,
                           const std::vector<std::pair<std::string, std::string>>&) override {
    samples_saved = view.volume ? view.volume->samples_per_voxel : 0.0;
    return "voxel.toml";
  }

  std::atomic<int> updated{0};
  std::atomic<double> samples_saved{0.0};

 private:
  static SceneState make(const SceneSettings& settings) {
    static const auto image = make_volume_image(volume_example("voxel"), kVolumeArray, "voxel");
    auto info = std::make_shared<SceneInfo>();
    info->name = "voxel";
    info->fields = {"scalars", "others"};
    info->bounds = image->bounds();
    info->anatomical = true;
    SceneState scene;
    scene.info = info;
    scene.settings = settings;
    scene.lines = std::make_shared<const std::vector<Line>>();
    scene.volume =
        VolumeView{.image = image,
                   .transfer = make_color_transfer(ColorPreset::kDensity, image->lowest, image->highest)};
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
}

TEST_F(VolumeWindow, SavesTheViewOfTheVolume) {
  options_.script.push_back({2, {.kind = InputKind::kKeyDown, .key = 'S', .modifiers = kModifierControl}});
  const WindowResult result = run_window(model_, options_);
  EXPECT_EQ(result.message, "saved voxel.toml");
  EXPECT_EQ(model_.samples_saved, VolumeView{}.samples_per_voxel);
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
