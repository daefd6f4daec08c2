/// Draws isosurfaces: lit triangles with depth (shaders/surface/).
#pragma once

#include <memory>
#include <vector>

#include "common/render/camera.h"
#include "common/render/color/color_tables.h"
#include "common/render/gl/object.h"
#include "common/render/line_style.h"
#include "common/render/surface/surface_view.h"

namespace palpate {

/// How surfaces with values are coloured.
struct SurfaceColors {
  LineStyle style;
  ValueRange range;
  float contour_width = 1.0F;  ///< [pixels]
  /// A ball with colours of its own (scene frame); no radius: none.
  Vec3f lens_center{0.0F};
  float lens_radius = 0.0F;
  LineStyle lens_style;
  ValueRange lens_range;
};

/// Keeps what it has uploaded while the meshes are the same objects. Needs the context current in which it
/// was made.
class SurfacePass {
 public:
  /// Uploads what has changed.
  void update(const std::vector<SurfaceView>& surfaces, const SceneFrame& frame);
  /// Into the framebuffer that is bound, the nearest in front. @pre The frame's uniform block is bound to 0.
  void draw(const SurfaceColors& colors);

 private:
  struct Uploaded {
    SurfaceView view;
    GlVertexArray vertex_array;
    GlBuffer vertices, triangles, values, lens_values;
    std::size_t corners = 0;
  };
  static void set_values(Uploaded& surface);
  /// @param over lines of equal value and the border of the lens alone.
  static void draw(const Uploaded& surface, const SurfaceColors& colors, bool over);

  GlProgram program_;  // compiled at the first use
  ColorTables tables_;
  std::vector<Uploaded> uploaded_;
  SceneFrame frame_;
};

}  // namespace palpate
