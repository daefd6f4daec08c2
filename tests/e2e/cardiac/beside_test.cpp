// Two hearts, or two results of one, beside each other: each half is the picture of its heart alone, from the same side
// and in one range of colours.
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <stb_image.h>

#include "apps/cardiac/cardiac_model.h"
#include "common/compose/appearance.h"
#include "common/compose/line_view.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/render/scene_view.h"
#include "common/scene/session.h"
#include "common/window/panels/panel.h"
#include "common/window/window.h"
#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

constexpr int kHalf = 200, kHeight = 160;

class CardiacBeside : public ExplorerTest {
 protected:
  CardiacBeside() : ExplorerTest("cardiac") {
    write_shell("a.vtk", 0.0, 1.0);
    write_shell("b.vtk", 300.0, 3.0);
    write_shell("tiny.vtk", 0.0, 3.0, 1e-3);
  }
  ~CardiacBeside() override = default;

  /// A bent square at x = `left` whose values go from 0 to `highest`.
  void write_shell(const std::string& name, double left, double highest, double scale = 1.0) const {
    std::ofstream file(folder_.path(name));
    file << "# vtk DataFile Version 3.0\ns\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n";
    for (const auto& [x, y, z] : {std::array{0, 0, 0}, {20, 0, 0}, {20, 10, 5}, {0, 10, 0}})
      file << scale * (left + x) << " " << scale * y << " " << scale * z << "\n";
    file
        << "CELLS 2 8\n3 0 1 2\n3 0 2 3\nCELL_TYPES 2\n5\n5\nPOINT_DATA 4\nSCALARS vm double\nLOOKUP_TABLE default\n";
    file << "0 " << 0.5 * highest << " " << highest << " 0\n";
  }
  Image picture(std::vector<std::string> arguments, int width, int height = kHeight) {
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), {"--size", std::to_string(width) + "x" + std::to_string(height),
                                       "--color-bar", "off", "--force", "--out", "p.png"});
    (void)json(arguments);
    return read_png("p.png");
  }
  Image read_png(const std::string& name) const {
    Image image;
    unsigned char* pixels = stbi_load(folder_.path(name).c_str(), &image.width, &image.height, nullptr, 4);
    EXPECT_NE(pixels, nullptr);
    if (pixels != nullptr) image.rgba.assign(pixels, pixels + 4L * image.width * image.height);
    stbi_image_free(pixels);
    return image;
  }
  /// The largest difference of a channel below the title, whose words differ. @param left of the part of `whole`.
  /// @param foot rows at the lower end that are not compared.
  static int difference(const Image& whole, int left, const Image& part, int foot = 0) {
    constexpr int kTitle = 40;
    int worst = whole.height == part.height ? 0 : 255;
    for (int y = kTitle; y < part.height - foot; ++y) {
      for (int x = 0; x < part.width; ++x) {
        const auto a = whole.pixel(left + x, y), b = part.pixel(x, y);
        for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(a[c] - b[c]));
      }
    }
    return worst;
  }
};

TEST_F(CardiacBeside, EachHalfIsThePictureOfItsHeartInOneRange) {
  const Image both = picture({"a.vtk", "--compare", "b.vtk"}, 2 * kHalf + 2);
  EXPECT_EQ(both.width, 2 * kHalf + 2);
  EXPECT_LE(difference(both, 0, picture({"a.vtk", "--range", "0,3"}, kHalf)), 1);
  EXPECT_LE(difference(both, kHalf + 2, picture({"b.vtk", "--range", "0,3"}, kHalf)), 1);
  EXPECT_GT(difference(both, 0, picture({"a.vtk"}, kHalf)), 20) << "alone it has all colours";
  const Image other = picture({"b.vtk", "--compare", "a.vtk"}, 2 * kHalf + 2);
  EXPECT_LE(difference(other, kHalf + 2, picture({"a.vtk", "--range", "0,3"}, kHalf)), 1)
      << "whichever of them reaches farther";
}

TEST_F(CardiacBeside, HeartsInOtherUnitsAreDrawnAsLargeAndThatIsSaid) {
  const Image both = picture({"a.vtk", "--compare", "tiny.vtk", "--scale-bar", "off"}, 2 * kHalf + 2);
  EXPECT_LE(difference(both, kHalf + 2, picture({"tiny.vtk", "--scale-bar", "off"}, kHalf)), 1);
}

TEST_F(CardiacBeside, ResultsOfOneMeshStandSideBySide) {
  std::ofstream(folder_.path("m.pts")) << "4\n0 0 0\n20000 0 0\n20000 10000 0\n0 10000 5000\n";
  std::ofstream(folder_.path("m.elem")) << "2\nTr 0 1 2 7\nTr 0 2 3 8\n";
  for (const char* const run : {"one", "two"}) std::filesystem::create_directory(folder_.path(run));
  std::ofstream(folder_.path("one/vm.dat")) << "0\n1\n1\n0\n";
  std::ofstream(folder_.path("two/vm.dat")) << "0\n4\n1\n0\n";
  const Image both =
      picture({"m.elem", "one/vm.dat", "--angle", "vm", "--compare", "two/vm.dat"}, 2 * kHalf + 2);
  EXPECT_LE(difference(both, 0, picture({"m.elem", "one/vm.dat", "--angle", "vm", "--range", "0,4"}, kHalf)),
            1);
  EXPECT_LE(difference(both, kHalf + 2,
                       picture({"m.elem", "two/vm.dat", "--angle", "vm", "--range", "0,4"}, kHalf)),
            1);
  const Image colours =
      picture({"m.elem", "one/vm.dat", "--angle", "vm", "--compare-angle", "region"}, 2 * kHalf + 2);
  EXPECT_LE(difference(colours, kHalf + 2, picture({"m.elem", "--angle", "region"}, kHalf)), 1);
}

TEST_F(CardiacBeside, AHeartThatMovesIsAtTheTimeOfTheOther) {
  write_shell("b1.vtk", 400.0, 3.0);
  const auto list = [&](const std::string& name, const std::string& first, const std::string& second) {
    std::ofstream(folder_.path(name))
        << "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0\" file=\"" << first
        << "\"/><DataSet timestep=\"1\" file=\"" << second << "\"/></Collection></VTKFile>";
  };
  list("still.pvd", "a.vtk", "a.vtk");
  list("moving.pvd", "b.vtk", "b1.vtk");
  Document document;
  document.common.threads = 1;
  document.input.kind = FieldKind::kFibre;
  document.input.files = {folder_.path("still.pvd")};
  document.input.time = "0";
  document.heart.beside = folder_.path("moving.pvd");
  CardiacModel model(document, "cardiac");
  Progress progress;
  const SceneState first = model.start(progress);
  ASSERT_TRUE(first.beside);
  EXPECT_NEAR(first.beside->bounds.lower.x, 300.0, 1e-6);
  Document later = first.document;
  for (const double step : {1.0, 0.0, 1.0}) {
    later.input.time = step > 0.0 ? "1" : "0";
    const SceneState then = model.update(later, progress);
    ASSERT_TRUE(then.beside);
    EXPECT_NEAR(then.beside->bounds.lower.x, 300.0 + 100.0 * step, 1e-6);
  }
}

TEST_F(CardiacBeside, WhatTwoHeartsCannotBeIsRefused) {
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--stereo", "rows"}, {"--turntable", "4"}, {"--compare", "nothing.vtk"}}) {
    std::vector<std::string> arguments{"render", "a.vtk", "--compare", "b.vtk", "--out", "no.png", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_NE(run(arguments).exit_code, 0) << more.front();
  }
  const ProgramResult result =
      run({"render", "--example", "ventricle", "--compare", "vm.igb", "--out", "no.png", "--json"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("needs its mesh"), std::string::npos) << result.err;
}

TEST_F(CardiacBeside, AWindowShowsBothAndItsSessionBringsThemBack) {
  if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
  Document document;
  document.common.threads = 1;
  document.input.kind = FieldKind::kFibre;
  document.input.files = {folder_.path("a.vtk")};
  document.heart.beside = folder_.path("b.vtk");
  WindowOptions window{.program = "cardiac", .width = 800, .height = 640, .picture_folder = folder_.path()};
  window.panels = cardiac_panels();
  window.touch.modes = modes_of(FieldKind::kFibre);
  window.screenshot = folder_.path("window.png");
  window.frames = 30;
  window.hidden = true;
  const auto show = [&](const Document& shown) {
    apply_appearance(shown, window.view);
    window.angles = camera_angles(shown.view.camera);
    window.focal_point = focal_point_of(shown.view);
    CardiacModel model(shown, "cardiac");
    WindowResult result = run_window(model, window);
    model.save_session(result.document, folder_.path("two.palpate.toml"));
    return result;
  };
  const WindowResult result = show(document);
  ASSERT_TRUE(result.view.beside);
  ASSERT_TRUE(result.view.style.array && result.view.beside->style.array);
  EXPECT_EQ(result.view.style.array->range, result.view.beside->style.array->range);
  const Image first = read_png("window.png");
  Document again;
  again.common.threads = 1;
  again.input.kind = FieldKind::kFibre;
  std::vector<std::string> notes;
  const Session session = load_session(folder_.path("two.palpate.toml"));
  for (const auto& [name, value] : session.options) {
    const Setting* const row = find_setting(name, FieldKind::kFibre);
    ASSERT_NE(row, nullptr) << name;
    set_value(*row, again, value);
  }
  EXPECT_EQ(again.heart.beside, document.heart.beside);
  again.input.files = document.input.files;
  (void)show(again);
  constexpr int kStatus = 60;  // times
  EXPECT_LE(difference(read_png("window.png"), 0, first, kStatus), 1);
}

}  // namespace
}  // namespace palpate::test
