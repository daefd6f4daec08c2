/// Draws isosurfaces: lit triangles with depth (shaders/surface/).
#pragma once

#include <memory>
#include <vector>

#include "common/render/camera.h"
#include "common/render/gl/object.h"
#include "common/render/surface/surface_view.h"

namespace palpate {

/// Keeps what it has uploaded while the meshes are the same objects. Needs the context current in which it
/// was made.
class SurfacePass {
 public:
  /// Uploads what has changed.
  void update(const std::vector<SurfaceView>& surfaces, const SceneFrame& frame);
  /// Into the framebuffer that is bound, the nearest in front. @pre The frame's uniform block is bound to 0.
  void draw();

 private:
  struct Uploaded {
    SurfaceView view;
    GlVertexArray vertex_array;
    GlBuffer vertices, triangles;
    std::size_t corners = 0;
  };

  GlProgram program_;  // compiled at the first use
  std::vector<Uploaded> uploaded_;
  SceneFrame frame_;
};

}  // namespace palpate
