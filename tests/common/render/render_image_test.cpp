#include "common/render/render_image.h"

#include <gtest/gtest.h>

#include "tests/common/render/sample_scenes.h"
using namespace palpate;
TEST(Look, Pictures) {
  auto v = test::whirlwind(1.6, 120);
  v.title = "whirlwind";
  v.subtitle = "120 lines";
  v.units = {"m", "s"};
  auto r = render_image(v, 1280, 800, 3);
  printf("%s first %.1f then %.1f ms\n", r.renderer.c_str(), r.first_frame_ms, r.frame_ms[1]);
  test::keep_picture(r.image, "dark");
  v.background = Background::kLight;
  v.style.color_by = ColorBy::kError;
  test::keep_picture(render_image(v, 1280, 800).image, "light");
  v.style.opacity = 0.4;
  v.style.color_by = ColorBy::kTermination;
  test::keep_picture(render_image(v, 1280, 800).image, "light_transparent");
  v.style.opacity = 1;
  v.style.color_by = ColorBy::kDirection;
  v.background = Background::kDark;
  test::keep_picture(render_image(v, 640, 400).image, "direction");
}
