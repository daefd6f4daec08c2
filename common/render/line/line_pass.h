/// Draws lines as illuminated ribbons of constant width that face the viewer (shaders/line/).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/render/color_map.h"
#include "common/render/gl/object.h"
#include "common/render/line/line_geometry.h"

namespace palpate {

/// How one set of lines is drawn.
struct LineDraw {
  enum class Coloring : int { kMap = 0, kDirection = 1, kOneColor = 2, kUnlit = 3 };
  Coloring coloring = Coloring::kMap;
  Rgb color{1.0F};          ///< for kOneColor and kUnlit
  float width = 3.0F;       ///< [pixels] at the focal point
  float min_width = 1.0F;   ///< [pixels] anywhere
  float halo_width = 0.0F;  ///< [pixels] beyond either edge; 0: none
  float opacity = 1.0F;
  Vec3f back{0.0F, 0.0F, 1.0F};  ///< toward the viewer; transparent segments are sorted along it
};

/// The compiled program and its colour tables, shared by all sets of lines. Needs the frame's uniform
/// block bound to 0.
class LineProgram {
 public:
  void use(ColorMap map);

 private:
  GlProgram program_;  ///< compiled at the first use
  std::array<GlTexture, kColorMapCount> tables_;
};

/// Lines on the GPU.
class LineSet {
 public:
  void set_geometry(LineGeometry geometry);
  /// One place in the colour map for each vertex.
  void set_values(std::span<const float> coordinates);
  /// @pre LineProgram::use().
  void draw(const LineDraw& how);

 private:
  void upload_segments();

  LineGeometry geometry_;
  bool has_values_ = false;
  bool sorted_ = false;
  Vec3f sorted_along_{0.0F};
  GlVertexArray vertex_array_;
  GlBuffer points_, values_, indices_;
};

}  // namespace palpate
