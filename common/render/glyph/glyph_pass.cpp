#include "common/render/glyph/glyph_pass.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/render/gl/program.h"

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

// Of shaders/glyph/sphere.vert.
constexpr GLint kHaloUniform = 0, kOpacityUniform = 1;
constexpr GLuint kSpheresBinding = 0;
constexpr GLsizei kCorners = 4;

// Of shaders/glyph/arrow.vert.
constexpr GLint kOpacity = 0;
constexpr GLuint kArrowsBinding = 0;
// Facets about the axis: no corner shows at the sizes of glyphs.
constexpr int kSides = 32;

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

void SpherePass::draw(std::span<const SphereInstance> spheres, float halo_width, float hidden_opacity,
                      GlyphPart part) {
  if (spheres.empty()) return;
  if (!program_) {
    program_ = compile_program("glyph/sphere.vert", "glyph/sphere.frag");
    const std::string halo = "HALO";
    halo_program_ =
        compile_program("glyph/sphere.vert", "glyph/sphere.frag", shader_files(), std::span(&halo, 1));
    no_vertices_ = make_vertex_array();
  }
  const GlBuffer instances = make_buffer(spheres);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kSpheresBinding, instances.name());
  glBindVertexArray(no_vertices_.name());
  const auto draw_with = [&](const GlProgram& program, float halo, float opacity) {
    glUseProgram(program.name());
    glUniform1f(kHaloUniform, halo);
    glUniform1f(kOpacityUniform, opacity);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, kCorners, static_cast<GLsizei>(spheres.size()));
  };
  draw_glyph_part(part, hidden_opacity, [&](float opacity) {
    if (halo_width > 0.0F && !(opacity < 1.0F)) draw_with(halo_program_, halo_width, opacity);
    draw_with(program_, 0.0F, opacity);
  });
}

void ArrowPass::draw(std::span<const ArrowInstance> arrows, float hidden_opacity, GlyphPart part) {
  if (arrows.empty()) return;
  if (!program_) {
    program_ = compile_program("glyph/arrow.vert", "glyph/arrow.frag");
    const auto mesh = make_arrow_mesh(kSides);
    mesh_ = make_buffer(std::span<const ArrowVertex>(mesh));
    corner_count_ = mesh.size();
    vertex_array_ = make_vertex_array();
    glVertexArrayVertexBuffer(vertex_array_.name(), 0, mesh_.name(), 0, sizeof(ArrowVertex));
    describe_attribute(vertex_array_.name(), 0, 2, offsetof(ArrowVertex, circle));
    describe_attribute(vertex_array_.name(), 1, 2, offsetof(ArrowVertex, along));
    describe_attribute(vertex_array_.name(), 2, 2, offsetof(ArrowVertex, radial));
    describe_attribute(vertex_array_.name(), 3, 3, offsetof(ArrowVertex, facing));
  }
  const GlBuffer instances = make_buffer(arrows);
  glUseProgram(program_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kArrowsBinding, instances.name());
  glBindVertexArray(vertex_array_.name());
  draw_glyph_part(part, hidden_opacity, [&](float opacity) {
    glUniform1f(kOpacity, opacity);
    glDrawArraysInstanced(GL_TRIANGLES, 0, static_cast<GLsizei>(corner_count_),
                          static_cast<GLsizei>(arrows.size()));
  });
}

namespace {

// A band of the surface between two circles about the axis.
struct Zone {
  glm::vec2 along0, radial0, along1, radial1;
  Vec3f facing;
};

const std::array<Zone, 4> kZones{{
    {{0.0F, 0.0F}, {0.0F, 0.0F}, {0.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 0.0F, 0.0F}},  // cap of the shaft
    {{0.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 0.0F}, {0.0F, 1.0F, 0.0F}},  // shaft
    {{1.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 0.0F}, {0.0F, 1.0F}, {1.0F, 0.0F, 0.0F}},  // neck of the head
    {{1.0F, 0.0F}, {0.0F, 1.0F}, {1.0F, 1.0F}, {0.0F, 0.0F}, {0.0F, 0.0F, 1.0F}},  // cone
}};

}  // namespace

std::vector<ArrowVertex> make_arrow_mesh(int sides) {
  PALPATE_CHECK(sides >= 3);
  const auto circle = [sides](int i) {
    // Side n is side 0 again, to the last bit: no crack.
    const double phi = 2.0 * std::numbers::pi * (i % sides) / sides;
    return glm::vec2(std::cos(phi), std::sin(phi));
  };
  std::vector<ArrowVertex> mesh;
  mesh.reserve(kZones.size() * 6 * as_size(sides));
  for (const Zone& zone : kZones) {
    for (int i = 0; i < sides; ++i) {
      const ArrowVertex a{circle(i), zone.along0, zone.radial0, zone.facing};
      const ArrowVertex b{circle(i + 1), zone.along0, zone.radial0, zone.facing};
      const ArrowVertex c{circle(i), zone.along1, zone.radial1, zone.facing};
      const ArrowVertex d{circle(i + 1), zone.along1, zone.radial1, zone.facing};
      mesh.insert(mesh.end(), {a, b, c, c, b, d});
    }
  }
  return mesh;
}

}  // namespace palpate
