// Where pictures of the plane put what they draw.

#include "lab/page/plane_picture.h"

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

TEST(PlanePicture, DrawsPanelsAtOneScaleWithOneLegend) {
  PlanePicture picture{
      .title = "a < b", .lower = {-1.0, 0.0}, .upper = {2.0, 3.0}, .bar = 1.0, .bar_label = "1 m"};
  // The corners of what is shown: y points up.
  const PictureCurve corners{.name = "corners", .points = {{-1.0, 0.0}, {2.0, 3.0}}};
  const PictureCurve dots{.name = "dots", .points = {{0.5, 1.5}}, .marks = true};
  picture.panels = {{.title = "left", .curves = {corners, dots}}, {.title = "right", .curves = {dots}}};
  const std::string out = svg(picture);
  EXPECT_NE(out.find("a &lt; b"), std::string::npos);
  EXPECT_NE(out.find("points=\"20.00,364.00 320.00,64.00 \""), std::string::npos) << out;
  EXPECT_NE(out.find("cx=\"170.00\" cy=\"214.00\""), std::string::npos) << "middle of the left panel";
  EXPECT_NE(out.find("cx=\"490.00\" cy=\"214.00\""), std::string::npos) << "middle of the right one";
  std::size_t count = 0;
  for (std::size_t at = out.find(">dots<"); at != std::string::npos; at = out.find(">dots<", at + 1)) ++count;
  EXPECT_EQ(count, 1U) << "once in the legend";
}

}  // namespace
}  // namespace palpate::test
