#include "common/render/render_image.h"

#include "common/render/gl/context.h"
#include "common/render/scene_renderer.h"

namespace palpate {

RenderedImage render_image(const SceneView& view, int width, int height, int repeat) {
  OffscreenContext context;
  RenderedImage result;
  result.renderer = gl_description();
  SceneRenderer renderer;
  renderer.draw(view, width, height);
  result.first_frame_ms = renderer.finish();
  for (int i = 0; i < repeat; ++i) {
    renderer.draw(view, width, height);
    result.frame_ms.push_back(renderer.finish());
  }
  result.image = renderer.read();
  return result;
}

}  // namespace palpate
