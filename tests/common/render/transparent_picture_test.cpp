#include "common/render/transparent_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "common/render/render_panes.h"
#include "tests/common/render/sample_scenes.h"

namespace palpate {
namespace {

// Put back on a background that it was not made from, it is what is drawn there.
TEST(TransparentPicture, LiesOnAnyBackgroundAsIfItWereDrawnThere) {
  constexpr int kWidth = 160, kHeight = 120;
  SceneView view = test::whirlwind(1.0, 40);
  view.camera = make_camera(view.bounds, {}, static_cast<double>(kWidth) / kHeight);
  const Image clear = transparent_picture(view, kWidth, kHeight);
  EXPECT_EQ(clear.pixel(kWidth - 1, kHeight / 2)[3], 0) << "where nothing is";
  constexpr float kGrey = 0.2F;
  view.background = {Rgb(kGrey), Rgb(kGrey)};
  const Image drawn = render_panes(view, kWidth, kHeight).image;
  int worst = 0, opaque = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto over = clear.pixel(x, y), wanted = drawn.pixel(x, y);
      const double alpha = over[3] / 255.0;
      opaque += over[3] == 255 ? 1 : 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const double there = alpha * over[c] + (1.0 - alpha) * 255.0 * kGrey;
        worst = std::max(worst, static_cast<int>(std::abs(there - wanted[c])));
      }
    }
  }
  EXPECT_GT(opaque, 100) << "lines";
  EXPECT_LE(worst, 6) << "rounding of 1/100 of alpha";
}

}  // namespace
}  // namespace palpate
