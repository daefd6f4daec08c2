#include "common/render/surface/surface_pass.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/render/gl/program.h"

namespace palpate {
namespace {

// Of shaders/surface/surface.*.
enum SurfaceUniform : GLint {
  kSurfaceColor = 0,
  kSurfaceHasValues = 1,
  kSurfaceScale = 2,
  kSurfaceLensScale = 3,
  kSurfaceLens = 4,
  kSurfaceContours = 5,
  kSurfaceOver = 6
};
constexpr GLuint kSurfaceTable = 0, kSurfaceLensTable = 1, kSurfaceValues = 1, kSurfaceLensValues = 2;

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

/// From a number to its place in the colour map: see the shader.
void set_surface_scale(GLint location, const LineStyle& style, const ValueRange& range) {
  const bool logarithmic = is_logarithmic(style);
  const double lower = logarithmic ? std::log(range.lower) : range.lower;
  const double extent = (logarithmic ? std::log(range.upper) : range.upper) - lower;
  // Without extent all has the colour in the middle.
  const bool one = !(extent > 0.0);
  glUniform3f(location, static_cast<float>(one ? lower - 0.5 : lower),
              static_cast<float>(one ? 1.0 : 1.0 / extent), logarithmic ? 1.0F : 0.0F);
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
      const SurfaceView shown = std::exchange(uploaded_.back().view, surface);
      if (shown.values != surface.values || shown.lens_values != surface.lens_values)
        set_values(uploaded_.back());
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
    describe_attribute(made.vertex_array.name(), 0, 3, offsetof(SurfaceVertex, position));
    describe_attribute(made.vertex_array.name(), 1, 3, offsetof(SurfaceVertex, normal));
    set_values(made);
    uploaded_.push_back(std::move(made));
  }
}

void SurfacePass::set_values(Uploaded& surface) {
  const GLuint array = surface.vertex_array.name();
  const auto set = [&](const std::shared_ptr<const std::vector<float>>& values, GLuint location,
                       GLuint binding, GlBuffer& buffer) {
    buffer.reset();
    if (!values) {
      glDisableVertexArrayAttrib(array, location);
      return;
    }
    PALPATE_CHECK(values->size() == surface.view.mesh->points.size());
    buffer = make_buffer(std::span<const float>(*values));
    glVertexArrayVertexBuffer(array, binding, buffer.name(), 0, sizeof(float));
    describe_attribute(array, location, 1, 0, binding);
  };
  constexpr GLuint kValue = 2, kLensValue = 3;  // locations
  set(surface.view.values, kValue, kSurfaceValues, surface.values);
  set(surface.view.lens_values, kLensValue, kSurfaceLensValues, surface.lens_values);
}

void SurfacePass::draw(const Uploaded& surface, const SurfaceColors& colors, bool over) {
  const Rgb& color = surface.view.color;
  glUniform4f(kSurfaceColor, color.r, color.g, color.b,
              static_cast<float>(std::clamp(surface.view.opacity, 0.0, 1.0)));
  const Vec3f& lens = colors.lens_center;
  glUniform1i(kSurfaceHasValues, surface.view.values ? 1 : 0);
  glUniform4f(kSurfaceLens, lens.x, lens.y, lens.z, surface.view.lens_values ? colors.lens_radius : 0.0F);
  glUniform2f(kSurfaceContours, static_cast<float>(surface.view.contours), colors.contour_width);
  glUniform1i(kSurfaceOver, over ? 1 : 0);
  glBindVertexArray(surface.vertex_array.name());
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(surface.corners), GL_UNSIGNED_INT, nullptr);
}

void SurfacePass::draw(const SurfaceColors& colors) {
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
  if (std::any_of(uploaded_.begin(), uploaded_.end(),
                  [](const Uploaded& each) { return each.view.values != nullptr; })) {
    const LineStyle& lens_style = colors.lens_radius > 0.0F ? colors.lens_style : colors.style;
    tables_.bind(color_map_of(colors.style), kSurfaceTable);
    tables_.bind(color_map_of(lens_style), kSurfaceLensTable);
  }
  set_surface_scale(kSurfaceScale, colors.style, colors.range);
  set_surface_scale(kSurfaceLensScale, colors.lens_style, colors.lens_range);
  for (const Uploaded& surface : uploaded_) draw(surface, colors, false);
  // What is drawn on a surface lies before the lines there.
  glPolygonOffset(-2.0F, -8.0F);
  glDepthMask(GL_FALSE);
  for (const Uploaded& surface : uploaded_) {
    if (surface.view.values &&
        (surface.view.contours > 0.0 || (surface.view.lens_values && colors.lens_radius > 0.0F)))
      draw(surface, colors, true);
  }
  glDepthMask(GL_TRUE);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  glBindVertexArray(0);
}

}  // namespace palpate
