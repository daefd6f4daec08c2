// Files in a window, by keyboard and mouse alone: opening, saving, closing, the start page.
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stop_token>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <stb_image.h>

#include "common/base/error.h"
#include "common/render/png.h"
#include "common/scene/input.h"
#include "common/window/files/thumbnails.h"
#include "tests/common/window/touch_window.h"

namespace palpate::test {
namespace {

class FileWindow : public TouchWindowTest {
 protected:
  void SetUp() override {
    TouchWindowTest::SetUp();
    if (IsSkipped()) return;
    const char* const home = std::getenv("HOME");
    if (home != nullptr) home_ = home;
    ::setenv("HOME", folder_.path().c_str(), 1);
    for (const char* name : {"a.vtk", "b.vtk", "notes.txt"}) folder_.write(name, "x");
    std::filesystem::create_directory(folder_.path("deep"));
    std::ofstream(folder_.path("deep/c.vtk")) << "x";
    options_.program = "flow";
    options_.session.clear();
    options_.recent = {{{folder_.path("a.vtk")}}};  // where the dialog begins
  }
  void TearDown() override {
    if (!home_.empty()) ::setenv("HOME", home_.c_str(), 1);
  }
  void control(int code, int more = 0) { key(code, kModifierControl | more); }

  std::string home_;
};

TEST_F(FileWindow, AFileIsOpenedByTheKeyboardAlone) {
  control('O');
  type("de");
  key(kEnter);  // goes into the folder
  type("c");
  key(kEnter);
  (void)run();
  EXPECT_EQ(model_.last_opened, (InputFiles{{folder_.path("deep/c.vtk")}}));
}

TEST_F(FileWindow, AFileIsOpenedByTheMouseAndWhatCannotBeOpenedIsNotListed) {
  control('O');
  press("b.vtk");
  press("Open");
  (void)run();
  EXPECT_EQ(model_.last_opened, (InputFiles{{folder_.path("b.vtk")}}));
  options_.script.clear();
  last_ = 0;
  control('O');
  options_.frames = last_ + 2 * kPause;
  options_.patience = 0.0;
  at_control(next(), {.kind = InputKind::kMove}, "notes.txt");
  options_.frames = last_ + 2 * kPause;
  EXPECT_EQ(run_window(model_, options_).missing, std::vector<std::string>{"notes.txt"});
}

TEST_F(FileWindow, OneOfSeveralSeriesIsChosenByTheMouse) {
  model_.several = {{"T1 axial", 40}, {"Head", 96}};
  control('O');
  press("b.vtk");
  press("Open");
  press("2  Head, 96 files");
  const WindowResult result = run();
  InputFiles wanted{{folder_.path("b.vtk")}};
  wanted.series = "2";
  EXPECT_EQ(model_.last_opened, wanted);
  EXPECT_EQ(result.missing, std::vector<std::string>{});
}

TEST_F(FileWindow, NoneOfSeveralSeriesIsOpenedWhereNoneIsWanted) {
  model_.several = {{"T1 axial", 40}, {"Head", 96}};
  control('O');
  press("b.vtk");
  press("Open");
  press("Cancel");
  key(kEscape);
  (void)run();
  EXPECT_EQ(model_.all_opened.size(), 1U);
}

TEST_F(FileWindow, SeveralAreMarkedAndOpenedTogether) {
  constexpr int kInsert = 260, kDown = 264;
  control('O');
  key(kDown);  // deep
  key(kDown);
  key(kInsert);
  key(kDown);
  key(kInsert);
  key(kEnter);
  (void)run();
  EXPECT_EQ(model_.last_opened, (InputFiles{{folder_.path("a.vtk"), folder_.path("b.vtk")}}));
}

TEST_F(FileWindow, EscapeLeavesTheDialogAndNothingIsOpened) {
  control('O');
  type("b");
  key(kEscape);
  (void)run();
  EXPECT_TRUE(model_.last_opened.files.empty());
  EXPECT_EQ(options_.recent.size(), 1U);
}

TEST_F(FileWindow, ASessionAsksForItsNameOnceInTheFolderOfTheUser) {
  std::filesystem::create_directory(folder_.path("Documents"));
  model_.file = folder_.path("deep/c.vtk");
  control('S');
  key(kEnter);
  control('S');  // there it goes again
  control('S', kModifierShift);
  type("other");
  key(kEnter);
  const WindowResult result = run();
  ASSERT_EQ(model_.saved_to.size(), 3U) << result.message;
  EXPECT_EQ(model_.saved_to[0], folder_.path("Documents/c.palpate.toml")) << "never beside the data";
  EXPECT_EQ(model_.saved_to[1], model_.saved_to[0]);
  EXPECT_EQ(model_.saved_to[2], folder_.path("Documents/other.palpate.toml")) << "the name is replaced";
}

TEST_F(FileWindow, ASessionOfThatNameIsReplacedOnlyWhereAskedForTwice) {
  model_.file = folder_.path("deep/c.vtk");
  folder_.write("c.palpate.toml", "of another");
  control('S');
  key(kEnter);
  key(kEscape);
  (void)run();
  EXPECT_TRUE(model_.saved_to.empty());
  options_.script.clear();
  last_ = 0;
  control('S');
  key(kEnter);
  key(kEnter);
  (void)run();
  EXPECT_EQ(model_.saved_to.size(), 1U);
}

TEST_F(FileWindow, DataAreClosedAndOthersOpenedFromTheStartPage) {
  control('W');
  const WindowResult closed = run();
  EXPECT_EQ(model_.closed, 1);
  EXPECT_TRUE(closed.view.lines == nullptr || closed.view.lines->empty());
  EXPECT_FALSE(closed.probe.held);
  press("a.vtk");  // the card of what was open lately
  const WindowResult opened = run();
  EXPECT_EQ(model_.last_opened, options_.recent.front());
  ASSERT_TRUE(opened.view.lines);
  EXPECT_FALSE(opened.view.lines->empty());
}

TEST_F(FileWindow, ClosingAsksForWhatIsNotSaved) {
  grab();
  key('K');
  key('G');
  control('W');
  key(kEscape);
  (void)run();
  EXPECT_EQ(model_.closed, 0);
  control('W');
  key('D');
  (void)run();
  EXPECT_EQ(model_.closed, 1);
}

TEST_F(FileWindow, WithoutAFileItBeginsWithExamples) {
  options_.start_page = true;
  (void)run();
  EXPECT_EQ(model_.updated, 0);
  EXPECT_TRUE(model_.last_opened.example.empty());
  const std::string first = examples_of(FieldKind::kVector).front().name;
  press(first);
  EXPECT_TRUE(run().shown);
  EXPECT_EQ(model_.last_opened.example, first);
}

TEST_F(FileWindow, TheStartPageLeadsBackToWhatIsOpen) {
  constexpr int kRight = 262;
  control('N');
  key('V');  // nothing that is behind it hears keys
  key(kEscape);
  EXPECT_EQ(run().message, "");
  EXPECT_TRUE(model_.last_opened.files.empty());
  options_.script.clear();
  last_ = 0;
  control('N');
  key(kRight);  // shows which card Enter opens
  key(kEnter);
  (void)run();
  EXPECT_EQ(model_.last_opened, options_.recent.front());
}

TEST_F(FileWindow, APictureIsExportedInItsOwnSizeWithoutABackground) {
  key('P', kModifierShift);
  press("size");
  press("1920 x 1080");
  press("transparent");
  press("Export");
  last_ += 40 * kPause;  // it is drawn meanwhile
  const WindowResult result = run();
  const std::filesystem::path file = folder_.path("flow.png");
  ASSERT_TRUE(std::filesystem::exists(file)) << result.message;
  int width = 0, height = 0, channels = 0;
  unsigned char* const pixels = stbi_load(file.c_str(), &width, &height, &channels, 4);
  ASSERT_NE(pixels, nullptr);
  EXPECT_EQ(width, 1920);
  EXPECT_EQ(height, 1080);
  EXPECT_EQ(pixels[4 * (1920 * 540 + 1900) + 3], 0) << "beside the lines";
  int opaque = 0;
  for (int i = 0; i < width * height; ++i) opaque += pixels[4 * i + 3] == 255 ? 1 : 0;
  stbi_image_free(pixels);
  EXPECT_GT(opaque, 1000);
}

TEST_F(FileWindow, ADroppedTableOfSeedsGoesIntoWhatIsOpen) {
  folder_.write("seeds.csv", "x,y,z\n0.5,0,0\n");
  at(next(), {.kind = InputKind::kDrop, .files = {folder_.path("seeds.csv")}});
  const WindowResult result = run();
  EXPECT_TRUE(model_.last_opened.files.empty());
  EXPECT_EQ(model_.updated, 1);
  folder_.write("colours.csv", "value,red,green,blue,opacity\n0,1,1,1,1\n");
  options_.script.clear();
  last_ = 0;
  at(next(), {.kind = InputKind::kDrop, .files = {folder_.path("colours.csv")}});
  EXPECT_NE(run().message.find("no volume is drawn"), std::string::npos) << "it says why it is not taken";
}

TEST_F(FileWindow, DataASessionAndSeedsAreDroppedTogether) {
  folder_.write("seeds.csv", "x,y,z\n0.5,0,0\n");
  folder_.write("s.palpate.toml", "format = 1\nprogram = 'flow'\n[scene]\n");
  at(next(), {.kind = InputKind::kDrop,
              .files = {folder_.path("s.palpate.toml"), folder_.path("b.vtk"), folder_.path("seeds.csv")}});
  (void)run();
  InputFiles wanted{{folder_.path("b.vtk")}};
  wanted.session = folder_.path("s.palpate.toml");
  wanted.seeds = folder_.path("seeds.csv");
  EXPECT_EQ(model_.last_opened, wanted);
  folder_.write("t.palpate.toml", "format = 1\n[scene]\n");
  options_.script.clear();
  last_ = 0;
  at(next(),
     {.kind = InputKind::kDrop, .files = {folder_.path("s.palpate.toml"), folder_.path("t.palpate.toml")}});
  EXPECT_NE(run().message.find("are two sessions"), std::string::npos);
}

TEST_F(FileWindow, TractsThatComeWithDataAreOpenedAfterThem) {
  at(next(), {.kind = InputKind::kDrop, .files = {folder_.path("t.tck"), folder_.path("b.vtk")}});
  last_ += 4 * kPause;
  (void)run();
  ASSERT_EQ(model_.all_opened.size(), 2U);
  EXPECT_EQ(model_.all_opened[0], (InputFiles{{folder_.path("b.vtk")}}));
  EXPECT_EQ(model_.all_opened[1], (InputFiles{{folder_.path("t.tck")}}));
}

TEST_F(FileWindow, ASessionOpensLikeAFileAndIsSavedThereAgain) {
  folder_.write("s.palpate.toml", "format = 1\nprogram = 'flow'\n[scene]\n");
  model_.of_session.view.background = "light";
  model_.of_session.view.camera = "90,0,0,2";
  model_.of_session.touch.stiffness = 150.0;
  control('O');
  type("s.pal");
  key(kEnter);
  control('S');
  const WindowResult result = run();
  EXPECT_EQ(model_.last_opened.session, folder_.path("s.palpate.toml"));
  EXPECT_EQ(result.view.background, Background::kLight);
  EXPECT_EQ(result.document.touch.stiffness, 150.0);
  EXPECT_TRUE(result.document.view.camera.starts_with("90,0,0,")) << result.document.view.camera;
  EXPECT_EQ(model_.saved_to, std::vector{folder_.path("s.palpate.toml")});
}

TEST_F(FileWindow, WhatWasSeenLastOfClosedDataIsKeptAsASmallPicture) {
  model_.file = folder_.path("a.vtk");
  options_.thumbnails = folder_.path("small");
  control('W');
  last_ += kPause;
  (void)run();
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path("small"))) files.push_back(entry);
  ASSERT_EQ(files.size(), 1U);
  int width = 0, height = 0, channels = 0;
  unsigned char* const pixels = stbi_load(files[0].c_str(), &width, &height, &channels, 3);
  ASSERT_NE(pixels, nullptr);
  EXPECT_EQ(width, 288);
  EXPECT_EQ(height, 192);
  unsigned char brightest = 0;
  for (int i = 0; i < 3 * width * height; ++i) brightest = std::max(brightest, pixels[i]);
  stbi_image_free(pixels);
  EXPECT_GT(brightest, 100) << "lines are in it";
}

TEST_F(FileWindow, ExamplesAreDrawnOnceInTheBackground) {
  options_.thumbnails = folder_.path("small");
  options_.start_page = true;
  std::atomic<int> drawn{0};
  options_.draw_example = [&](const std::string& example, const std::filesystem::path& to, int width,
                              int height, const std::stop_token&) {
    ++drawn;
    if (example == "abc") throw work_error("cannot be drawn");
    Image image{.width = width, .height = height, .rgba = {}};
    image.rgba.assign(std::size_t{4} * 288 * 192, 200);
    write_png(to, image, {});
  };
  last_ += 4 * kPause;
  (void)run();
  const auto count = static_cast<int>(examples_of(FieldKind::kVector).size());
  EXPECT_EQ(drawn, count);
  (void)run();
  EXPECT_EQ(drawn, count + 1) << "that which could not be drawn is tried again, and no other";
}

TEST(SmallPicture, IsTheMiddleOfALargerOne) {
  Image image{.width = 400, .height = 100, .rgba = {}};
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 400; ++x) {
      const auto level = static_cast<std::uint8_t>(x < 125 || x >= 275 ? 0 : 250);
      for (int c = 0; c < 4; ++c) image.rgba.push_back(level);
    }
  }
  const Image small = small_picture(image, 30, 20);
  for (int x = 0; x < 30; ++x) EXPECT_EQ(small.pixel(x, 10)[0], 250) << x;
  EXPECT_TRUE(small_picture({}, 30, 20).rgba.empty());
}

}  // namespace
}  // namespace palpate::test
