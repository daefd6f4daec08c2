#include "common/render/surface/surface_pass.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include <epoxy/gl.h>

#include "common/render/gl/program.h"

namespace palpate {
namespace {

// Of shaders/surface/surface.*.
constexpr GLint kColor = 0;

/// As laid out for the shader.
struct SurfaceVertex {
  Vec3f position{0.0F};  ///< scene frame
  Vec3f normal{0.0F};
};

std::vector<SurfaceVertex> vertices_of(const IsosurfaceMesh& mesh, const SceneFrame& frame) {
  std::vector<SurfaceVertex> vertices(mesh.points.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    vertices[i] = {Vec3f(frame.scene_from_data(mesh.points[i])), mesh.normals[i]};
  }
  return vertices;
}

void describe(const GlVertexArray& array, GLuint location, std::size_t offset) {
  glEnableVertexArrayAttrib(array.name(), location);
  glVertexArrayAttribFormat(array.name(), location, 3, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(array.name(), location, 0);
}

}  // namespace

void SurfacePass::update(const std::vector<SurfaceView>& surfaces, const SceneFrame& frame) {
  const bool same_frame = frame.center == frame_.center && frame.exponent == frame_.exponent;
  std::vector<Uploaded> before = std::exchange(uploaded_, {});
  frame_ = frame;
  for (const SurfaceView& surface : surfaces) {
    if (!surface.mesh || surface.mesh->triangles.empty()) continue;
    const auto known = std::find_if(before.begin(), before.end(), [&](const Uploaded& each) {
      return same_frame && each.view.mesh == surface.mesh;
    });
    if (known != before.end()) {
      uploaded_.push_back(std::move(*known));
      before.erase(known);
      uploaded_.back().view = surface;
      continue;
    }
    const std::vector<SurfaceVertex> vertices = vertices_of(*surface.mesh, frame);
    const auto& triangles = surface.mesh->triangles;
    Uploaded made{.view = surface,
                  .vertex_array = make_vertex_array(),
                  .vertices = make_buffer(std::span<const SurfaceVertex>(vertices)),
                  .triangles = make_buffer(std::span(triangles)),
                  .corners = 3 * triangles.size()};
    glVertexArrayVertexBuffer(made.vertex_array.name(), 0, made.vertices.name(), 0, sizeof(SurfaceVertex));
    glVertexArrayElementBuffer(made.vertex_array.name(), made.triangles.name());
    describe(made.vertex_array, 0, offsetof(SurfaceVertex, position));
    describe(made.vertex_array, 1, offsetof(SurfaceVertex, normal));
    uploaded_.push_back(std::move(made));
  }
}

void SurfacePass::draw() {
  if (uploaded_.empty()) return;
  if (!program_) program_ = compile_program("surface/surface.vert", "surface/surface.frag");
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  // A little back, so that lines that lie on a surface are before it.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.0F, 2.0F);
  glUseProgram(program_.name());
  for (const Uploaded& surface : uploaded_) {
    const Rgb& color = surface.view.color;
    glUniform4f(kColor, color.r, color.g, color.b,
                static_cast<float>(std::clamp(surface.view.opacity, 0.0, 1.0)));
    glBindVertexArray(surface.vertex_array.name());
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(surface.corners), GL_UNSIGNED_INT, nullptr);
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  glBindVertexArray(0);
}

}  // namespace palpate
