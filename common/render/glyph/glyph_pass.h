/// Draws arrows and, without heads, tubes: one mesh, instanced (arrow_mesh.h, shaders/glyph/arrow.*).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "common/math/vec.h"
#include "common/render/color/color_map.h"
#include "common/render/gl/object.h"

namespace palpate {

// Draws spheres by casting a ray for each sample (shaders/glyph/sphere.*): round at any size, with exact
// silhouette and depth, four vertices each.

// What glyphs hide and what hides them: the draws that spheres, arrows and tensors have in common.

/// What is drawn of glyphs.
enum class GlyphPart : std::uint8_t {
  kAll,       ///< draw_hidden_then_seen()
  kSeenAgain  ///< what is in sight, once more over what has been drawn before it since: draw_seen_again()
};

/// Calls `draw(opacity)` with the state for what nothing hides, by its opacity and without depth.
/// @pre what is drawn is in the depths already.
void draw_seen_again(float opacity, const std::function<void(float opacity)>& draw);

/// Calls `draw(opacity)` with the state for the part that something nearer hides, where `hidden_opacity`
/// is above zero, and then with that for the part in sight, opaque and with depth.
void draw_hidden_then_seen(float hidden_opacity, const std::function<void(float opacity)>& draw);

/// Either of both.
void draw_glyph_part(GlyphPart part, float opacity, const std::function<void(float opacity)>& draw);

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
  GlProgram program_, halo_program_;  // compiled at the first use
  GlVertexArray no_vertices_;
};

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
