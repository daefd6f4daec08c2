#include "common/render/glyph/glyph_draw.h"

#include <epoxy/gl.h>

namespace palpate {

void draw_hidden_then_seen(float hidden_opacity, const std::function<void(float opacity)>& draw) {
  glEnable(GL_DEPTH_TEST);
  if (hidden_opacity > 0.0F) {
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    draw(hidden_opacity);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
  }
  glDepthFunc(GL_LEQUAL);
  draw(1.0F);
}

}  // namespace palpate
