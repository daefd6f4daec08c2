#include "common/load/series_list.h"

#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

TEST(SeriesList, IsReadAsItIsWritten) {
  const std::array<ListedSeries, 3> series{
      {{"2 T1 (axial, fat), 3 (x", 40}, {"", 1}, {"CT head: holds 2 series: 1 (a, 1 file)", 96}}};
  const std::string line = series_question("/data/1 (old)", series);
  EXPECT_EQ(asked_series(line),
            (std::vector<std::string>{"2 T1 (axial, fat), 3 (x, 40 files", ", 1 file",
                                      "CT head: holds 2 series: 1 (a, 1 file), 96 files"}));
  EXPECT_NE(line.find("1 (2 T1"), std::string::npos);
  EXPECT_NE(line.find("--series NUMBER"), std::string::npos);
}

TEST(SeriesList, OfAnyOtherLineThereIsNone) {
  for (const char* line : {"", "a.dcm: holds no image", "x: holds 2 series: 1 (a, 1 file)",
                           "; choose one by --series NUMBER", "x); choose one by --series NUMBER"})
    EXPECT_TRUE(asked_series(line).empty()) << line;
}

}  // namespace
}  // namespace palpate::test
