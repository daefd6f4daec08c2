// A radiologist's assistant, with the mouse alone: a folder of mixed series, one of which is chosen, read in four panes,
// measured, cropped and written; other programs find the same voxels there.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
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
#include "common/load/load.h"
#include "common/render/png.h"
#include "common/render/slice/slice_panes.h"
#include "common/render/volume/voxels/volume_image.h"
#include "common/window/controls/region_control.h"
#include "common/window/panels/panel.h"
#include "common/window/panels/volume/volume_panel.h"
#include "common/window/window.h"
#include "tests/e2e/explorer_test.h"
#include "tests/loaders/dicom/dicom_fixture.h"
#include "tests/support/project_folders.h"

namespace palpate::test {
namespace {

constexpr int kColumns = 64, kRows = 48, kSlices = 40;
constexpr double kStep = 3.0, kThick = 4.0;  // [mm]
constexpr double kRadius = 15.0;             // of the nodule [mm]

/// Hounsfield units at a place in LPS [mm]: a body with two lungs, a spine, and a nodule in the left lung; all but that
/// is noisy.
int chest(const Vec3& x, int number) {
  const int noise = number * 31 % 37 % 23;
  const auto within = [&x](const Vec3& c, const Vec3& r) {
    const Vec3 d = (x - c) / r;
    return glm::dot(d, d) < 1.0;
  };
  if (glm::distance(x, Vec3(45.0, 0.0, -30.0)) < kRadius) return 60;
  if (within({45.0, 0.0, 0.0}, {30.0, 45.0, 70.0}) || within({-45.0, 0.0, 0.0}, {30.0, 45.0, 70.0}))
    return -850;
  if (std::hypot(x.x, x.y - 48.0) < 10.0) return 700 + noise;
  return within(Vec3(0.0), {92.0, 68.0, 400.0}) ? 40 + noise : -1000 + noise;
}

class GridReading : public ExplorerTest {
 protected:
  GridReading() : ExplorerTest("grid") {
    for (int k = 0; k < 3; ++k)
      (void)folder_.write("study/a" + std::to_string(k), image(k, "1.2.7", "scout", 40.0).bytes());
    for (int k = 0; k < kSlices; ++k)
      (void)folder_.write("study/b" + std::to_string(97 * k % 41),
                          image(k, "1.2.8", "chest", kThick).bytes());
    (void)folder_.write("study/readme.txt", "of the scanner");
    (void)folder_.write("study/damaged.dcm", std::string(128, '\0') + "DICM");
  }

  // Where sessions go.
  void SetUp() override {
    const char* const home = std::getenv("HOME");
    if (home != nullptr) home_ = home;
    ::setenv("HOME", folder_.path().c_str(), 1);
  }
  void TearDown() override {
    if (!home_.empty()) ::setenv("HOME", home_.c_str(), 1);
  }

  static DicomImage image(int k, const std::string& series, const std::string& title, double thick) {
    DicomImage made;
    made.columns = kColumns;
    made.rows = kRows;
    made.column_step = made.row_step = kStep;
    made.instance = k + 1;
    made.series = series;
    made.title = title;
    made.modality = "CT";
    made.slope = 1.0;
    made.intercept = -1024.0;
    made.window = {{40.0, 400.0}};
    made.position = {-0.5 * kStep * (kColumns - 1), -0.5 * kStep * (kRows - 1),
                     thick * (k - 0.5 * (kSlices - 1))};
    for (int j = 0; j < kRows; ++j)
      for (int i = 0; i < kColumns; ++i)
        made.pixels.push_back(static_cast<std::uint16_t>(
            chest(made.position + kStep * Vec3(i, j, 0), i + 7 * j + 3 * k) + 1024));
    return made;
  }

  WindowResult open() {
    const ParsedCommand parsed = parse_command_line(explorer_, {"open"});
    const QuietVerb verb(explorer_);
    WindowOptions window{.program = "grid",
                         .width = kWidth,
                         .height = kHeight,
                         .kind = FieldKind::kScalar,
                         .start_page = true,
                         .recent = {{{folder_.path("study/b0")}}},  // where the dialog begins
                         .picture_folder = folder_.path(),
                         .touch = window_touch(modes_of(FieldKind::kScalar), parsed.options, verb.context),
                         .panels = {draw_volume},
                         .script = script_};
    window.frames = next_ + 30;
    window.patience = 60.0;
    window.screenshot = folder_.path("window.png");
    GridModel model(parsed.options, "grid");
    WindowResult result = run_window(model, window);
    if (const char* folder = std::getenv("PALPATE_PICTURES"))
      std::filesystem::copy(window.screenshot, std::filesystem::path(folder) / "grid_reading.png",
                            std::filesystem::copy_options::overwrite_existing);
    if (std::getenv("PALPATE_WRITE_PAGES") != nullptr) write_page(window.screenshot);
    return result;
  }
  /// The picture of the guide: without the status line, which names the folder of this test.
  static void write_page(const std::filesystem::path& screenshot) {
    const PictureArea area = layout(kWidth, kHeight, kTextHeight).picture;
    int width = 0, height = 0, channels = 0;
    unsigned char* const pixels = stbi_load(screenshot.c_str(), &width, &height, &channels, 4);
    ASSERT_NE(pixels, nullptr);
    Image page{width, static_cast<int>(area.height), {}};
    page.rgba.assign(pixels, pixels + std::ptrdiff_t{4} * page.width * page.height);
    stbi_image_free(pixels);
    write_png(source_folder() / "docs/guide/grid_reading.png", page, {});
  }

  void at(InputEvent event) { script_.push_back({next_ += 2, std::move(event)}); }
  void move(const Vec2& to) { at({.kind = InputKind::kMove, .x = to.x, .y = to.y}); }
  void drag(const Vec2& from, const Vec2& to, MouseButton button = MouseButton::kLeft) {
    move(from);
    at({.kind = InputKind::kPress, .button = button});
    for (int i = 1; i <= 4; ++i) move(from + (to - from) * (0.25 * i));
    at({.kind = InputKind::kRelease, .button = button});
    next_ += 4;
  }
  /// On a control of the panel, by its label.
  void press(const std::string& label) {
    for (const InputKind kind : {InputKind::kMove, InputKind::kPress, InputKind::kRelease})
      script_.push_back({.frame = next_ += 2, .event = {.kind = kind}, .control = label});
    next_ += 6;
  }
  /// Where a place is in the pane of a plane. @param bounds of the volume, whose middle is in the panes'.
  static Vec2 in_pane(SlicePlane plane, const Vec3& place, const Box& bounds) {
    const PictureArea area = layout(kWidth, kHeight, kTextHeight).picture;
    SlicePanes panes{.layout = 4,
                     .cross = bounds.center(),
                     .center = bounds.center(),
                     .shown = {},
                     .window = {},
                     .box = {}};
    const std::vector<Pane> parts =
        panes_of(panes, static_cast<int>(area.width), static_cast<int>(area.height));
    for (const Pane& pane : parts) {
      if (pane.plane != plane) continue;
      const Camera camera =
          pane_camera(panes, plane, true, bounds, pane_view_height(panes, bounds, true, parts, pane));
      const Vec3 off = place - camera.focal_point;
      const double pixel = camera.view_height / pane.height;
      return {area.left + pane.left + 0.5 * pane.width + glm::dot(off, camera.axes[0]) / pixel,
              area.top + pane.top + 0.5 * pane.height - glm::dot(off, camera.axes[1]) / pixel};
    }
    return {};
  }

  static constexpr int kWidth = 1100, kHeight = 860;
  static constexpr float kTextHeight = 14.0F;
  const Explorer explorer_{.name = "grid", .kind = FieldKind::kScalar, .verbs = {open_volume_verb({})}};
  std::string home_;
  std::vector<ScriptedEvent> script_;
  int next_ = 4;
};

/// What the crop is to other programs: voxels of it that differ from those of the series at the same places.
constexpr const char* kPeers = R"py(
import glob, sys
import nibabel, numpy, pydicom
crop = nibabel.load(sys.argv[1])
slices = [s for s in (pydicom.dcmread(f) for f in glob.glob(sys.argv[2] + '/b*')) if s.SeriesInstanceUID == '1.2.8']
slices.sort(key=lambda s: float(s.ImagePositionPatient[2]))
whole = numpy.stack([s.pixel_array * float(s.RescaleSlope) + float(s.RescaleIntercept) for s in slices])
first, dz = slices[0], float(slices[1].ImagePositionPatient[2]) - float(slices[0].ImagePositionPatient[2])
voxels = numpy.asanyarray(crop.dataobj)
index = numpy.stack(numpy.meshgrid(*[numpy.arange(n) for n in voxels.shape], indexing='ij'), -1)
ras = index @ crop.affine[:3, :3].T + crop.affine[:3, 3]
lps = ras * [-1, -1, 1]
at = (lps - [float(v) for v in first.ImagePositionPatient]) / [float(first.PixelSpacing[1]), float(first.PixelSpacing[0]), dz]
near = numpy.rint(at).astype(int)
same = whole[near[..., 2], near[..., 1], near[..., 0]]
inside = numpy.linalg.norm(ras - [-45, 0, -30], axis=-1) < 15
index = numpy.stack(numpy.meshgrid(*[numpy.arange(n) for n in whole.shape], indexing='ij'), -1)[..., ::-1]
place = (index * [first.PixelSpacing[1], first.PixelSpacing[0], dz] + [float(v) for v in first.ImagePositionPatient]) * [-1, -1, 1]
nodule = numpy.linalg.norm(place - [-45, 0, -30], axis=-1) < 15
print('all of it', int(nodule.sum()) == int(inside.sum()) == int((voxels[inside] == 60).sum()))
try:
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
    reader = vtk.vtkNIFTIImageReader()
    reader.SetFileName(sys.argv[1])
    reader.Update()
    image = reader.GetOutput()
    seen = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(image.GetDimensions(), order='F')
    print('in VTK', seen.dtype, seen.shape == voxels.shape and int((seen != voxels).sum()))
except ImportError:
    print('no VTK here')
print(voxels.size, crop.get_data_dtype(), numpy.abs(at - near).max() < 1e-3, int((same != voxels).sum()), (voxels == 60).sum() > 100)
)py";

TEST_F(GridReading, ByMouseAloneAndBackInOtherPrograms) {
  if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
  LoadRequest request;
  request.files = {folder_.path("study")};
  request.series = "2";
  Source source = Source::open(request);
  const Box bounds = make_volume_image(source.read({"scalars"}).front(), "scalars", "chest")->bounds();
  const Vec3 nodule{-45.0, 0.0, -30.0};  // RAS

  press("Open…");
  press("Open");  // the folder that is shown
  press("2  chest, 40 files");
  press("layout");
  press("4");
  // To the nodule: in the coronal pane, then in the axial one.
  drag(in_pane(SlicePlane::kCoronal, nodule, bounds), in_pane(SlicePlane::kCoronal, nodule, bounds));
  drag(in_pane(SlicePlane::kAxial, nodule, bounds), in_pane(SlicePlane::kAxial, nodule, bounds));
  // A wider window, as for lungs.
  const Vec2 air = in_pane(SlicePlane::kSagittal, nodule + Vec3(0, 30, 40), bounds);
  drag(air, air + Vec2(300.0, 90.0), MouseButton::kRight);
  // Its diameter.
  press("Mark by clicks");
  for (const double side : {-1.0, 1.0}) {
    const Vec2 end = in_pane(SlicePlane::kAxial, nodule + Vec3(side * kRadius, 0, 0), bounds);
    drag(end, end);
  }
  press("Stop marking");
  press("+ box");
  // All of the nodule: the box to its left in the axial pane, and down in the coronal one.
  const Box first = new_region(bounds);
  Box wanted = first;
  wanted.lower.x = -72.0;
  wanted.lower.z = -60.0;
  const auto face = [&](int axis, const Box& box) {
    Vec3 at = box.center();
    at[axis] = box.lower[axis];
    return at;
  };
  Box left = first;
  left.lower.x = wanted.lower.x;
  drag(in_pane(SlicePlane::kAxial, face(0, first), bounds),
       in_pane(SlicePlane::kAxial, face(0, left), bounds));
  drag(in_pane(SlicePlane::kCoronal, face(2, left), bounds),
       in_pane(SlicePlane::kCoronal, face(2, wanted), bounds));
  press(".nii.gz");
  press("Save picture");
  press("Save session");
  press("Save");  // under the name that is offered
  move(in_pane(SlicePlane::kAxial, nodule + Vec3(5, -8, 0), bounds));
  const WindowResult read = open();

  EXPECT_EQ(read.missing, std::vector<std::string>{}) << read.log;
  ASSERT_TRUE(read.view.volume) << read.log;
  const VolumeView& volume = *read.view.volume;
  EXPECT_EQ(volume.panes.layout, 4);
  const double pixel = kStep;  // none is larger than a voxel
  EXPECT_LT(glm::distance(volume.panes.cross, nodule), 2.0 * pixel);
  ASSERT_TRUE(volume.planes.window);
  EXPECT_GT(volume.planes.window->width, 500.0) << "400 are the header's";
  const std::string session = read_file(folder_.path("study.palpate.toml")), mark = "annotation = 'length:";
  const std::size_t mark_at = session.find(mark);
  ASSERT_NE(mark_at, std::string::npos) << session;
  std::array<double, 6> ends{};
  ASSERT_EQ(std::sscanf(session.c_str() + mark_at + mark.size(), "%lf,%lf,%lf,%lf,%lf,%lf", &ends[0],
                        &ends[1], &ends[2], &ends[3], &ends[4], &ends[5]),
            6);
  ASSERT_TRUE(read.region);
  EXPECT_LT(glm::distance(read.region->lower, wanted.lower), pixel);
  EXPECT_EQ(read.region->upper, wanted.upper);
  EXPECT_NEAR(std::hypot(ends[3] - ends[0], ends[4] - ends[1], ends[5] - ends[2]), 2.0 * kRadius, 1.0);
  std::filesystem::path crop, picture;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    if (entry.path().string().ends_with(".nii.gz")) crop = entry.path();
    if (entry.path().extension() == ".png" && entry.path().filename() != "window.png") picture = entry.path();
  }
  EXPECT_FALSE(picture.empty()) << read.log;
  ASSERT_FALSE(crop.empty()) << read.log;

  const auto script = folder_.write("peers.py", kPeers);
  constexpr const char* kPython = "/usr/bin/python3";
  if (std::system((std::string(kPython) + " -c 'import nibabel, pydicom' 2>/dev/null").c_str()) != 0) {
    std::cout << "no nibabel or pydicom here: nothing was compared\n";
    return;
  }
  FILE* const pipe = popen((std::string(kPython) + " " + script.string() + " " + crop.string() + " " +
                            folder_.path("study").string() + " 2>&1")
                               .c_str(),
                           "r");
  ASSERT_NE(pipe, nullptr);
  std::array<char, 4096> text{};
  const std::size_t got = std::fread(text.data(), 1, text.size() - 1, pipe);
  pclose(pipe);
  const std::string said(text.data(), got);
  EXPECT_NE(said.find(" int16 True 0 True"), std::string::npos) << said;
  EXPECT_NE(said.find("all of it True"), std::string::npos) << said;
  EXPECT_TRUE(said.find("no VTK here") != std::string::npos ||
              said.find("in VTK int16 0") != std::string::npos)
      << said;
}

}  // namespace
}  // namespace palpate::test
