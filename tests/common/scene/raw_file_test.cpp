#include "common/scene/raw_file.h"

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

TEST(RawFile, OptionsWinOverTheSidecarAndThatOverTheName) {
  const test::TempFolder folder;
  const auto file = folder.write("a_2x2x2_uint8.raw", std::string(8, '\0'));
  std::string note;
  EXPECT_EQ(raw_layout_of(file, {}, note)->size, Index3(2, 2, 2));
  EXPECT_NE(note.find("name"), std::string::npos);

  folder.write("a_2x2x2_uint8.raw.toml",
               "[raw]\nsize = \"4x2x1\"\ntype = \"uint8\"\nspacing = \"1,2,3\"\nskip = 0\n");
  const auto sidecar = raw_layout_of(file, {}, note);
  EXPECT_EQ(sidecar->size, Index3(4, 2, 1));
  EXPECT_EQ(sidecar->spacing, Vec3(1, 2, 3));
  EXPECT_NE(note.find(".toml"), std::string::npos);

  note.clear();
  EXPECT_EQ(raw_layout_of(file, {.size = "1x2x4", .type = "int8"}, note)->size, Index3(1, 2, 4));
  EXPECT_EQ(note, "");
}

TEST(RawFile, ANameThatDoesNotFitTheFileSaysNothing) {
  const test::TempFolder folder;
  std::string note;
  EXPECT_FALSE(raw_layout_of(folder.write("a_2x2x2_uint8.raw", std::string(9, '\0')), {}, note));
  EXPECT_FALSE(raw_layout_of(folder.write("a_2x2x2_map.raw", std::string(8, '\0')), {}, note));
  EXPECT_FALSE(raw_layout_of(folder.path("lost_2x2x2_uint8.raw"), {}, note));
  EXPECT_EQ(note, "");
}

TEST(RawFile, ABrokenSidecarIsABadInputThatIsNamed) {
  const test::TempFolder folder;
  const auto file = folder.write("a.raw", std::string(8, '\0'));
  for (const char* text :
       {"[raw", "size = \"2x2x2\"\n", "[raw]\nsize = \"2x2x2\"\n", "[raw]\nwidth = 3\n",
        "[raw]\nsize = [2, 2, 2]\ntype = \"uint8\"\n", "[raw]\nsize = \"2x2x2\"\ntype = \"uint9\"\n"}) {
    folder.write("a.raw.toml", text);
    std::string note;
    try {
      (void)raw_layout_of(file, {}, note);
      ADD_FAILURE() << text << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput) << text;
      EXPECT_NE(std::string(error.what()).find("a.raw.toml"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace palpate
