// What lies flat over a picture besides titles: caption, scale, and at which border colours are explained.

#include <algorithm>
#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/render_image.h"
#include "tests/common/render/sample_scenes.h"

namespace palpate {
namespace {

constexpr int kWidth = 480, kHeight = 360;

// Where a picture of a view differs from another one; none: nowhere.
struct Place {
  int left = kWidth, right = -1, top = kHeight, bottom = -1;
  [[nodiscard]] bool none() const { return right < left; }
};

Place difference(const Image& a, const Image& b) {
  Place place;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (a.pixel(x, y) == b.pixel(x, y)) continue;
      place = {std::min(place.left, x), std::max(place.right, x), std::min(place.top, y),
               std::max(place.bottom, y)};
    }
  }
  return place;
}

Image draw(const SceneView& view) { return render_image(view, kWidth, kHeight).image; }

SceneView scene() {
  SceneView view = test::whirlwind(static_cast<double>(kWidth) / kHeight, 6);
  view.show_axes = view.show_outline = view.show_color_bar = false;
  return view;
}

TEST(OverlayParts, ACaptionStandsAtTheFootInTheMiddleAndIsWrapped) {
  SceneView view = scene();
  const Image without = draw(view);
  view.caption = "A whirlwind";
  Image with = draw(view);
  const Place one = difference(without, with);
  ASSERT_FALSE(one.none());
  EXPECT_NEAR(0.5 * (one.left + one.right), 0.5 * kWidth, 3.0);
  EXPECT_GT(one.top, 0.9 * kHeight);
  for (int i = 0; i < 5; ++i) view.caption += " that winds up faster";
  with = draw(view);
  test::cache_picture(with, "overlay_caption");
  const Place several = difference(without, with);
  EXPECT_LT(several.top, one.top - 8) << "in several lines";
  EXPECT_GE(several.left, 0.24 * kWidth);
  EXPECT_LE(several.right, 0.76 * kWidth);
}

TEST(OverlayParts, TheScaleIsARoundLengthOfWhatLiesAtTheFocalPoint) {
  SceneView view = scene();
  view.lines.reset();
  view.camera.projection = Projection::kOrthographic;
  view.camera.view_height = 3.6;  // a hundredth a pixel: 0.96 of the 4.8 are a fifth
  const Image without = draw(view);
  view.show_scale_bar = true;
  const Image with = draw(view);
  test::cache_picture(with, "overlay_scale");
  const Place scale = difference(without, with);
  ASSERT_FALSE(scale.none());
  EXPECT_NEAR(scale.right - scale.left, 50, 3) << "0.5";
  EXPECT_GT(scale.left, kWidth / 2);
  view.camera.view_height = 3.7e-8;
  EXPECT_FALSE(difference(without, draw(view)).none()) << "of anything";
}

TEST(OverlayParts, ColoursAreExplainedAtTheBorderThatIsChosen) {
  SceneView view = scene();
  const Image without = draw(view);
  view.show_color_bar = true;
  const Place right = difference(without, draw(view));
  view.color_bar_left = true;
  const Image at_left = draw(view);
  test::cache_picture(at_left, "overlay_left");
  const Place left = difference(without, at_left);
  ASSERT_FALSE(right.none() || left.none());
  EXPECT_GT(right.left, kWidth / 2);
  EXPECT_LT(left.right, kWidth / 2);
  EXPECT_NEAR(left.right - left.left, right.right - right.left, 2);
  EXPECT_NEAR(left.top, right.top, 1);
  EXPECT_NEAR(left.left, kWidth - 1 - right.right, 4) << "as far from its border";
}

}  // namespace
}  // namespace palpate
