#include "common/render/png.h"

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <stb_image.h>

#include "common/base/error.h"
#include "tests/support/png_texts.h"

namespace palpate {
namespace {

Image gradient() {
  Image image{5, 3, {}};
  for (int i = 0; i < 15; ++i) {
    for (const int v : {i * 10, 255 - i, i * i, 255}) image.rgba.push_back(static_cast<std::uint8_t>(v));
  }
  return image;
}

TEST(Png, HoldsThePixels) {
  const Image image = gradient();
  const auto png = encode_png(image, {{"Comment", "flow render carotid.vtk --out a.png"}});
  int width = 0, height = 0, channels = 0;
  stbi_uc* pixels =
      stbi_load_from_memory(png.data(), static_cast<int>(png.size()), &width, &height, &channels, 4);
  ASSERT_NE(pixels, nullptr);
  EXPECT_EQ(width, 5);
  EXPECT_EQ(height, 3);
  EXPECT_EQ(std::memcmp(pixels, image.rgba.data(), image.rgba.size()), 0);
  std::free(pixels);
}

// The check sum of an empty IEND chunk is a known number of the standard; the one of tEXt is checked
// against a value computed with zlib.
TEST(Png, TextChunkHasTheStandardsLayout) {
  const auto png = encode_png(gradient(), {{"Title", "x"}});
  const std::vector<std::uint8_t> expected{0,   0,   0,   7, 't', 'E',  'X',  't',  'T', 'i',
                                           't', 'l', 'e', 0, 'x', 0x29, 0x7E, 0x4D, 0x3A};
  const std::vector<std::uint8_t> found(png.begin() + 33,
                                        png.begin() + 33 + static_cast<long>(expected.size()));
  EXPECT_EQ(found, expected);
}

TEST(Png, TextsAreReadBack) {
  const std::vector<PngText> texts{{"Software", "flow (Palpate) 0.1.0"},
                                   {"Comment", "flow render 'Strömung.vtk' --out b.png"}};
  const auto found = test::png_texts(encode_png(gradient(), texts));
  ASSERT_EQ(found.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(found[i].keyword, texts[i].keyword);
    EXPECT_EQ(found[i].text, texts[i].text);
  }
  EXPECT_TRUE(test::png_texts({1, 2, 3}).empty());
}

TEST(Png, FileThatCannotBeWrittenIsNamedAndLeavesNothing) {
  const auto folder = std::filesystem::temp_directory_path() / "palpate_png_test";
  std::filesystem::remove_all(folder);
  try {
    write_png(folder / "a.png", gradient(), {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kWorkFailed);
    EXPECT_NE(std::string(error.what()).find("a.png"), std::string::npos);
  }
  std::filesystem::create_directories(folder);
  write_png(folder / "a.png", gradient(), {});
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace palpate
