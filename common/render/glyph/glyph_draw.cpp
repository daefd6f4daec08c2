#include "common/render/glyph/glyph_draw.h"

#include <epoxy/gl.h>

namespace palpate {
namespace {

// Over what is there, where the depth test `passes`, leaving depths as they are.
void draw_faintly(GLenum passes, float opacity, const std::function<void(float opacity)>& draw) {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(passes);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  draw(opacity);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

}  // namespace

void draw_seen_again(float opacity, const std::function<void(float opacity)>& draw) {
  draw_faintly(GL_LEQUAL, opacity, draw);
}

void draw_hidden_then_seen(float hidden_opacity, const std::function<void(float opacity)>& draw) {
  if (hidden_opacity > 0.0F) draw_faintly(GL_GREATER, hidden_opacity, draw);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  draw(1.0F);
}

void draw_glyph_part(GlyphPart part, float opacity, const std::function<void(float opacity)>& draw) {
  (part == GlyphPart::kAll ? draw_hidden_then_seen : draw_seen_again)(opacity, draw);
}

}  // namespace palpate
