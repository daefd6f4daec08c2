// A hand on a volume of scalars, in the window: no flow, so nothing is followed or kept.

#include <cmath>

#include "common/base/text.h"
#include "common/field/analytic/volume_examples.h"
#include "common/field/value_histogram.h"
#include "common/hand/mode/grid_mode.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/window/panels/volume/volume_panel.h"
#include "tests/common/window/touch_window.h"

namespace palpate::test {
namespace {

/// Three joined blobs.
class BlobModel final : public WindowModel {
 public:
  SceneState start(Progress&) override {
    Document document;
    document.input.field = kVolumeArray;
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
  static SceneState make(const Document& document) {
    static const DataSet data = volume_example("blob");
    static const auto image = make_volume_image(data, kVolumeArray, "blob");
    static const auto field = make_scalar_field({data}, {kVolumeArray, Association::kPoint, 0}, "blob", 1);
    auto info = std::make_shared<SceneInfo>();
    info->name = "blob";
    info->fields = {kVolumeArray};
    info->bounds = image->bounds();
    SceneState scene{.info = info, .document = document};
    scene.lines = std::make_shared<const std::vector<Line>>();
    scene.haptic_scalar = field;
    scene.volume =
        VolumeView{.image = image,
                   .transfer = make_color_transfer(ColorPreset::kDensity, image->lowest, image->highest),
                   .samples_per_voxel = 0.25};  // nobody looks at it
    return scene;
  }
};

class TouchVolume : public TouchWindowTest {
 protected:
  void SetUp() override {
    TouchWindowTest::SetUp();
    options_.panels = {draw_volume};
    options_.touch.modes = modes_of(FieldKind::kScalar);
    options_.touch.choice.mode = mode_of("isosurface");
    grow_to(1200);
  }
  static std::size_t mode_of(const std::string& name) {
    const std::vector<HapticMode> modes = modes_of(FieldKind::kScalar);
    return static_cast<std::size_t>(&find_mode(modes, name) - modes.data());
  }
  static int key_of(const std::string& name) { return '1' + static_cast<int>(mode_of(name)); }
  WindowResult run() { return run_model(blob_); }

  BlobModel blob_;
};

TEST_F(TouchVolume, TheHandIsOnTheProbeAndReadsTheScalar) {
  grab();
  const WindowResult result = run();
  EXPECT_TRUE(result.probe.held);
  EXPECT_EQ(result.probe.servo.hand.chain.links, 1);
  EXPECT_EQ(result.probe.scalar_name, kVolumeArray);
  ASSERT_TRUE(result.probe.scalar);
  EXPECT_GT(*result.probe.scalar, 0.0);
  EXPECT_FALSE(result.probe.sampled) << "there is no flow";
  EXPECT_FALSE(result.probe.cell.empty());
  ASSERT_TRUE(result.view.probe);
  EXPECT_TRUE(is_finite(result.view.probe->probe));
}

TEST_F(TouchVolume, TheWallHoldsTheProxyBackOnTheIsovalue) {
  grow_to(640);  // a turn of the wheel is as long as pixels are
  grab();
  // From the surface into it, by less than it gives.
  at(next(), {.kind = InputKind::kWheel, .y = 1.0});
  last_ += 3 * kPause;
  const WindowResult result = run();
  EXPECT_EQ(result.probe.state, HoldState::kHeld);
  EXPECT_GT(result.probe.force, 0.05);
  ASSERT_TRUE(result.probe.scalar);
  Progress progress;
  const auto felt = blob_.start(progress).haptic_scalar;
  EXPECT_NEAR(*result.probe.scalar, otsu_threshold(*felt), 1e-6 * felt->highest());
}

TEST_F(TouchVolume, TheHandBeginsOnTheSurfaceThatIsDrawn) {
  grab();
  const WindowResult result = run();
  ASSERT_EQ(result.view.surfaces.size(), 1U);
  const auto& mesh = result.view.surfaces[0].mesh;
  ASSERT_TRUE(mesh);
  EXPECT_FALSE(mesh->triangles.empty());
  Progress progress;
  const auto felt = blob_.start(progress).haptic_scalar;
  EXPECT_EQ(mesh->level, otsu_threshold(*felt));
  ASSERT_TRUE(result.probe.scalar);
  EXPECT_NEAR(*result.probe.scalar, mesh->level, 1e-6 * felt->highest());
}

TEST_F(TouchVolume, AnotherIsovalueMovesTheSurface) {
  press("##isovalue", 0, kMost);
  const WindowResult result = run();
  ASSERT_EQ(result.view.surfaces.size(), 1U);
  ASSERT_TRUE(result.view.surfaces[0].mesh);
  Progress progress;
  const auto felt = blob_.start(progress).haptic_scalar;
  EXPECT_GT(result.view.surfaces[0].mesh->level, 0.9 * felt->highest());
}

TEST_F(TouchVolume, SurfacesAreAddedAndSaved) {
  press("+ isosurface");
  last_ += 3 * kPause;
  EXPECT_EQ(run().view.surfaces.size(), 2U);
  key('S', kModifierControl);
  const std::string saved = run().message;
  EXPECT_NE(saved.find("isovalue="), std::string::npos) << saved;
}

TEST_F(TouchVolume, OtherModesShowNoSurface) {
  key(key_of("density"));
  EXPECT_TRUE(run().view.surfaces.empty());
}

TEST_F(TouchVolume, AnotherModeIsFeltAfterItsKey) {
  key(key_of("density"));
  grab();
  EXPECT_EQ(run().message.find("no line"), std::string::npos);
  key('K');
  EXPECT_NE(run().message.find("no line is followed"), std::string::npos) << "nothing can be kept here";
}

TEST_F(TouchVolume, TheSessionHoldsWhatIsFelt) {
  options_.touch.choice.mode = mode_of("density");
  options_.touch.choice.settings.stiffness = 300.0;
  key('S', kModifierControl);
  const std::string saved = run().message;
  EXPECT_NE(saved.find("mode=density"), std::string::npos) << saved;
  EXPECT_NE(saved.find("stiffness=300"), std::string::npos) << saved;
}

TEST_F(TouchVolume, ADragOnTheSphereTurnsThePlaneAndCutsTheVolume) {
  options_.touch.choice.mode = mode_of(kPlaneWidgetMode);
  const WindowResult before = run();
  ASSERT_TRUE(before.view.volume);
  ASSERT_EQ(before.view.volume->cuts.size(), 1U);
  const CuttingPlane cut = before.view.volume->cuts[0];
  EXPECT_TRUE(cut.on);
  EXPECT_TRUE(before.view.volume->lenses.empty()) << "planes are no lenses";
  // The sphere is in the middle of the picture, where the press takes hold of it.
  move_by(next(), 12.0, -14.0);
  at(next(), {.kind = InputKind::kPress});
  lead_to(80.0, -60.0);
  at(next(), {.kind = InputKind::kRelease});
  last_ += kPause;
  const WindowResult turned = run();
  ASSERT_EQ(turned.view.volume->cuts.size(), 1U) << "the same plane";
  EXPECT_FALSE(turned.view.volume->cuts[0] == cut);
  EXPECT_EQ(turned.view.camera.axes, before.view.camera.axes) << "the view stays";
  // And back.
  key('Z', kModifierControl);
  last_ += kPause;
  const WindowResult undone = run();
  EXPECT_LT(glm::distance(undone.view.volume->cuts[0].kept.outward, cut.kept.outward), 1e-12);
  EXPECT_EQ(undone.message, "undone");
}

// The arrow before a plane folds its numbers; there is room for another one below.
TEST_F(TouchVolume, APlaneFoldsInThePanel) {
  options_.touch.choice.mode = mode_of(kPlaneWidgetMode);
  press("##fold");
  press("+ plane");
  last_ += kPause;
  const WindowResult result = run();
  ASSERT_TRUE(result.view.volume);
  EXPECT_EQ(result.view.volume->cuts.size(), 2U);
}

// Measured on a thread of its own; once it is, the hand feels and reads it.
TEST_F(TouchVolume, TheNoiseIsFeltWhenItIsMeasured) {
  options_.touch.choice.mode = mode_of("density");
  options_.touch.choice.settings.texture.by_noise = true;
  grab();
  last_ += 3 * kPause;
  const WindowResult result = run();
  EXPECT_TRUE(result.probe.held);
  ASSERT_TRUE(result.probe.noise);
  EXPECT_GT(*result.probe.noise, 0.0);
}

TEST_F(TouchVolume, AButtonCutsAcrossAnAxisOfTheGridAtTheProxy) {
  options_.touch.choice.mode = mode_of(kGridMode);
  grab();
  press("1st");
  last_ += kPause;
  const WindowResult result = run();
  ASSERT_TRUE(result.view.volume);
  ASSERT_EQ(result.view.volume->cuts.size(), 1U);
  const ConvexShape::HalfSpace& kept = result.view.volume->cuts[0].kept;
  EXPECT_EQ(kept.outward, Vec3(1.0, 0.0, 0.0));
  EXPECT_EQ(kept.offset, result.probe.proxy.x) << "to the bit";
}

// In mode grid the button takes hold of the face that the probe is at; Ctrl+Z lets it be where it was.
TEST_F(TouchVolume, TheHandOnAGridDragsAFaceOfTheRegion) {
  options_.touch.choice.mode = mode_of(kGridMode);
  grab();
  const WindowResult before = run();
  const Vec3 start = before.probe.proxy;
  const double wide = 0.4 * before.view.bounds.size().x;
  const Box box{start - Vec3(wide), start + Vec3(0.0, wide, wide)};
  options_.region = box;
  key('X');
  at(next(), {.kind = InputKind::kPress});
  lead_to(60.0, 0.0);
  last_ += kPause;
  const WindowResult held = run();
  ASSERT_TRUE(held.region);
  EXPECT_GT(held.probe.proxy.x, start.x + 0.05 * wide);
  EXPECT_EQ(held.region->upper.x, held.probe.proxy.x) << "to the bit";
  EXPECT_EQ(held.region->lower, box.lower);
  EXPECT_EQ(held.region->upper.y, box.upper.y);
  EXPECT_EQ(held.region->upper.z, box.upper.z);
  at(next(), {.kind = InputKind::kRelease});
  key('Z', kModifierControl);
  const WindowResult undone = run();
  ASSERT_TRUE(undone.region);
  EXPECT_EQ(undone.region->upper, box.upper);
}

TEST_F(TouchVolume, APlaneGoesThroughThreePointsThatTheMouseMarks) {
  choose("annotation", "angle");
  press("Mark by clicks");
  for (const auto& [dx, dy] : {std::pair(0.0, 0.0), std::pair(30.0, 5.0), std::pair(5.0, 30.0)})
    click(next(), middle_x_ + dx, middle_y_ + dy);
  press("+ plane");
  key('S', kModifierControl);
  const WindowResult result = run();
  ASSERT_TRUE(result.view.volume);
  ASSERT_EQ(result.view.volume->cuts.size(), 1U) << result.message;
  const std::string words = "annotation=angle:";
  const std::size_t found = result.message.find(words);
  ASSERT_NE(found, std::string::npos) << result.message;
  const std::string text = result.message.substr(found + words.size());
  const auto v = parse_numbers(text.substr(0, text.find_first_of(" =;")), 9, text);
  const ConvexShape::HalfSpace& plane = result.view.volume->cuts[0].kept;
  for (std::size_t i = 0; i < 9; i += 3)
    EXPECT_NEAR(glm::dot(plane.outward, Vec3(v[i], v[i + 1], v[i + 2])), plane.offset, 1e-12) << text;
}

TEST_F(TouchVolume, AsksBeforeAnnotationsAreLost) {
  press("Mark by clicks");
  click(next(), middle_x_, middle_y_);
  click(next(), middle_x_ + 20.0, middle_y_);
  const auto marked = options_.script;
  key('Q');
  key('Z', kModifierControl);  // not for the picture now
  EXPECT_EQ(run().frames, options_.frames) << "asked";
  key('D');
  last_ += kPause;
  EXPECT_LT(run().frames, options_.frames) << "discarded";
  options_.script = marked;
  key('Q');
  key('S');
  last_ += kPause;
  EXPECT_LT(run().frames, options_.frames) << "saved";
  EXPECT_TRUE(std::filesystem::exists(folder_.path("annotations.csv")));
  options_.script = marked;
  key('S', kModifierControl);
  key('Q');
  last_ += kPause;
  EXPECT_LT(run().frames, options_.frames) << "they are in the session";
}

// What was of places and values of the old input is not saved as the new one's; how the hand feels stays.
TEST_F(TouchVolume, AnotherInputForgetsAnnotationsPlanesAndIsovalues) {
  options_.touch.choice.settings.stiffness = 300.0;
  press("Mark by clicks");
  click(next(), middle_x_, middle_y_);
  click(next(), middle_x_ + 20.0, middle_y_);
  press("Stop marking");
  press("##isovalue", 0, kMost);
  choose("mode", kPlaneWidgetMode);
  const auto settings_of = [](std::string message, const std::string& name) {
    const std::size_t at = message.find(" " + name + "=");
    return at == std::string::npos ? std::string() : message.substr(at, message.find(' ', at + 1) - at);
  };
  last_ += 2 * kPause;
  const auto untouched = options_.script;
  const int until = last_;
  move_by(next(), 12.0, -14.0);
  at(next(), {.kind = InputKind::kPress});
  lead_to(80.0, -60.0);
  at(next(), {.kind = InputKind::kRelease});
  const auto made = options_.script;
  const int end = last_;
  key('S', kModifierControl);
  const std::string old = run().message;
  EXPECT_NE(settings_of(old, "annotation"), "") << old;
  EXPECT_NE(settings_of(old, "isovalue"), "") << old;
  EXPECT_NE(settings_of(old, "planes"), "") << old;
  options_.script = made;
  last_ = end;
  at(next(), {.kind = InputKind::kDrop, .files = {"other.nrrd"}});
  key('D');  // they are not saved
  last_ += 3 * kPause;
  key('S', kModifierControl);  // other data: a name is asked for
  last_ += kPause;
  key(kEnter);
  const std::string other = run().message;
  EXPECT_EQ(settings_of(other, "annotation"), "") << other;
  EXPECT_EQ(settings_of(other, "isovalue"), "") << other;
  EXPECT_EQ(settings_of(other, "stiffness"), " stiffness=300") << other;
  EXPECT_EQ(settings_of(other, "mode"), settings_of(old, "mode"));
  options_.script = untouched;
  last_ = until;
  key('S', kModifierControl);
  const std::string plain = run().message;
  EXPECT_EQ(settings_of(other, "planes"), settings_of(plain, "planes")) << "where they begin";
}

TEST_F(TouchVolume, TheSessionHoldsThePlanes) {
  options_.touch.choice.mode = mode_of(kPlaneWidgetMode);
  options_.touch.choice.settings.plane_widget.poses.count = 1;
  options_.touch.choice.settings.plane_widget.poses.pose[0].center = {0.1, 0.2, 0.3};
  last_ += kPause;
  key('S', kModifierControl);
  const std::string saved = run().message;
  EXPECT_NE(saved.find("mode=plane-widget"), std::string::npos) << saved;
  EXPECT_NE(saved.find("planes=0.1,0.2,0.3,0,0,0,1"), std::string::npos) << saved;
}

}  // namespace
}  // namespace palpate::test
