#include "common/render/gl/target.h"

#include <vector>

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "common/render/gl/context.h"

namespace palpate {
namespace {

std::vector<float> depths_of(std::uint32_t texture, int width, int height) {
  std::vector<float> depths(static_cast<std::size_t>(width * height), -1.0F);
  glGetTextureImage(texture, 0, GL_DEPTH_COMPONENT, GL_FLOAT, static_cast<GLsizei>(4 * depths.size()),
                    depths.data());
  return depths;
}

TEST(RenderTarget, CopiesTheDepthsOfTheSceneAsTheyAre) {
  const OffscreenContext context;
  RenderTarget target;
  target.resize(8, 4, 1.0);
  target.bind_scene();
  glClearDepth(1.0);
  glClear(GL_DEPTH_BUFFER_BIT);
  glEnable(GL_SCISSOR_TEST);
  glScissor(2, 1, 3, 2);
  glClearDepth(0.125);
  glClear(GL_DEPTH_BUFFER_BIT);
  glDisable(GL_SCISSOR_TEST);
  const std::vector<float> depths = depths_of(target.copy_depth(), 8, 4);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 8; ++x) {
      const bool inside = x >= 2 && x < 5 && y >= 1 && y < 3;
      EXPECT_EQ(depths[static_cast<std::size_t>(8 * y + x)], inside ? 0.125F : 1.0F) << x << " " << y;
    }
  }
  // Another size: another texture of that size, and the depths of that scene.
  target.resize(16, 6, 0.5);
  target.bind_scene();
  glClearDepth(0.5);
  glClear(GL_DEPTH_BUFFER_BIT);
  EXPECT_EQ(depths_of(target.copy_depth(), 8, 3), std::vector<float>(24, 0.5F));
}

}  // namespace
}  // namespace palpate
