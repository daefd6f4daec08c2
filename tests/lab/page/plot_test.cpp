#include "lab/page/plot.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(LogLogPlot, HasAMarkerForEachPointAndLegendEntry) {
  const std::string text =
      svg({.title = "T",
           .x_label = "seconds",
           .y_label = "error",
           .series = {{"first", {{1e-3, 1e-2}, {1e-2, 1e-6}}}, {"other", {{1e-3, 1e-4}}}}});
  EXPECT_EQ(count(text, "<circle"), 3U);  // two points and the legend
  EXPECT_EQ(count(text, "<polyline"), 2U);
  EXPECT_EQ(count(text, ">first<"), 1U);
  EXPECT_EQ(count(text, ">seconds<"), 1U);
  EXPECT_EQ(text.find("<svg "), 0U);
  EXPECT_EQ(count(text, "nan"), 0U);
}

// Infinite, missing and zero values have no place on a logarithmic scale; they must not spoil the axes
// either.
TEST(LogLogPlot, LeavesOutWhatHasNoLogarithm) {
  const std::string text = svg(
      {.series = {{"s", {{1.0, 1.0}, {2.0, 0.0}, {3.0, -1.0}, {4.0, NAN}, {5.0, HUGE_VAL}, {0.0, 1.0}}}}});
  EXPECT_EQ(count(text, "<circle"), 2U);  // one point and the legend
  EXPECT_EQ(count(text, "nan") + count(text, "inf"), 0U);
  EXPECT_NE(svg({.series = {{"s", {{1.0, 0.0}}}}}).find("nothing to draw"), std::string::npos);
}

// Names begin at 694; a letter is at least 6 wide.
TEST(LogLogPlot, HasRoomForLongNames) {
  const auto width = [](std::size_t letters) {
    const std::string text = svg({.series = {{std::string(letters, 'm'), {{1.0, 1.0}}}}});
    return std::stod(text.substr(text.find("viewBox=\"0 0 ") + 13));
  };
  EXPECT_EQ(width(5), width(12));
  EXPECT_GT(width(60), 694.0 + 6.0 * 60);
}

TEST(LogLogPlot, DrawsTheFloorWithinTheFrame) {
  const std::string with = svg({.series = {{"s", {{1.0, 1e-3}}}}, .floor = 1e-9, .floor_label = "agreement"});
  EXPECT_EQ(count(with, ">agreement<"), 1U);
  EXPECT_NE(with.find("1e-9"), std::string::npos) << "the axis must reach down to the floor";
  EXPECT_EQ(count(svg({.series = {{"s", {{1.0, 1e-3}}}}, .floor_label = "agreement"}), ">agreement<"), 0U);
}

TEST(Escaped, KeepsMarkupOutOfTexts) {
  EXPECT_EQ(escaped("<a href=\"x\">&'"), "&lt;a href=&quot;x&quot;&gt;&amp;&#39;");
  const std::string text = svg({.title = "</svg><script>", .series = {{"<b>", {{1.0, 1.0}}}}});
  EXPECT_EQ(count(text, "<script>") + count(text, "<b>"), 0U);
}

}  // namespace
}  // namespace palpate::test
