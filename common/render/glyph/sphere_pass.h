/// Draws spheres by casting a ray for each sample (shaders/glyph/sphere.*): round at any size, with exact
/// silhouette and depth, four vertices each.
#pragma once

#include <span>

#include "common/math/vec.h"
#include "common/render/color/color_map.h"
#include "common/render/gl/object.h"
#include "common/render/glyph/glyph_draw.h"

namespace palpate {

/// One sphere, as laid out in the shader's buffer.
struct SphereInstance {
  Vec3f center{0.0F};   ///< scene frame
  float radius = 0.0F;  ///< scene frame
  Rgb color{1.0F};
  float padding = 0.0F;
};

class SpherePass {
 public:
  /// @param halo_width [pixels] in the colour of the background around each.
  /// @param hidden_opacity where something nearer hides them; 0: nothing of them is seen there. Of
  /// GlyphPart::kSeenAgain that of all.
  /// @pre The frame's uniform block is bound to 0.
  void draw(std::span<const SphereInstance> spheres, float halo_width, float hidden_opacity,
            GlyphPart part = GlyphPart::kAll);

 private:
  GlProgram program_;  // compiled at the first use
  GlVertexArray no_vertices_;
};

}  // namespace palpate
