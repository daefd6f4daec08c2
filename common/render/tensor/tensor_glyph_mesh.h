/// The mesh and the program that all tensor glyphs are drawn with (shaders/tensor/glyph.*).
#pragma once

#include <span>

#include "common/render/gl/object.h"
#include "common/render/glyph/glyph_pass.h"
#include "common/render/tensor/tensor_glyphs.h"

namespace palpate {

/// Needs the context current in which it was made.
class TensorGlyphMesh {
 public:
  /// Draws `glyphs`, opaque and with depth. @param fine with facets that do not show on large glyphs.
  /// @param hidden_opacity of what something nearer hides; 0: hidden is hidden. Of
  /// GlyphPart::kSeenAgain that of all.
  /// @pre The frame's uniform block is bound to 0.
  void draw(std::span<const TensorGlyph> glyphs, bool fine, float hidden_opacity = 0.0F,
            GlyphPart part = GlyphPart::kAll);

 private:
  /// Facets of the sphere: twice as many around as from pole to pole.
  struct Mesh {
    GlVertexArray array;
    GlBuffer corners, indices;
    int index_count = 0;
  };
  static Mesh make_mesh(int bands);

  GlProgram program_;  // compiled at the first use
  Mesh coarse_, fine_;
};

}  // namespace palpate
