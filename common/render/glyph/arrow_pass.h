/// Draws arrows and, without heads, tubes: one mesh, instanced (arrow_mesh.h, shaders/glyph/arrow.*).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "common/math/vec.h"
#include "common/render/color/color_map.h"
#include "common/render/gl/object.h"
#include "common/render/glyph/glyph_draw.h"

namespace palpate {

/// One arrow from `origin` along the unit vector `axis`, as laid out in the shader's buffer. Scene frame.
struct ArrowInstance {
  Vec3f origin{0.0F};
  float shaft_radius = 0.0F;
  Vec3f axis{0.0F, 0.0F, 1.0F};
  float shaft_length = 0.0F;
  float head_radius = 0.0F;  ///< zero, as the head's length, for a tube
  float head_length = 0.0F;
  float padding0 = 0.0F, padding1 = 0.0F;
  Rgb color{1.0F};
  float padding2 = 0.0F;
};

class ArrowPass {
 public:
  /// @param hidden_opacity where something nearer hides them; 0: nothing of them is seen there. Of
  /// GlyphPart::kSeenAgain that of all.
  /// @pre The frame's uniform block is bound to 0.
  void draw(std::span<const ArrowInstance> arrows, float hidden_opacity, GlyphPart part = GlyphPart::kAll);

 private:
  GlProgram program_;  // compiled at the first use
  GlVertexArray vertex_array_;
  GlBuffer mesh_;
  std::size_t corner_count_ = 0;
};

// The mesh that all arrows and tubes are drawn with: a surface of revolution whose parts the shader
// scales for each instance (shaders/glyph/arrow.vert states how).

/// A corner, as laid out for the shader.
struct ArrowVertex {
  glm::vec2 circle{0.0F};  ///< cosine and sine of the angle about the axis
  glm::vec2 along{0.0F};   ///< lengths of shaft and head that lie below
  glm::vec2 radial{0.0F};  ///< radii of shaft and head that lie within
  Vec3f facing{0.0F};      ///< weights of the normals of cap, shaft and cone
};

/// Triangles, three corners each: cap, shaft, neck and cone with `sides` facets about the axis.
/// @pre sides >= 3.
[[nodiscard]] std::vector<ArrowVertex> make_arrow_mesh(int sides);

}  // namespace palpate
