#include "common/render/line/line_pass.h"

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/render/gl/program.h"

namespace palpate {
namespace {

// Locations and bindings of shaders/line/.
enum Uniform : GLint {
  kWidth = 0,
  kHaloWidth = 1,
  kMinWidth = 2,
  kHasValues = 3,
  kColoring = 4,
  kLineColor = 5
};
constexpr GLuint kPointsBinding = 0, kValuesBinding = 1, kTableUnit = 0;

GlTexture make_table_texture(ColorMap map) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  GlTexture texture(name);
  const auto& table = color_table(map);
  glTextureStorage2D(name, 1, GL_RGB32F, kColorTableSize, 1);
  glTextureSubImage2D(name, 0, 0, 0, kColorTableSize, 1, GL_RGB, GL_FLOAT, table.data());
  const GLint filter = map == ColorMap::kCategorical ? GL_NEAREST : GL_LINEAR;
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, filter);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, filter);
  glTextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

}  // namespace

void LineProgram::use(ColorMap map) {
  if (!program_) program_ = compile_program("line/line.vert", "line/line.frag");
  GlTexture& table = tables_[static_cast<std::size_t>(map)];
  if (!table) table = make_table_texture(map);
  glUseProgram(program_.name());
  glBindTextureUnit(kTableUnit, table.name());
}

void LineSet::set_geometry(LineGeometry geometry) {
  geometry_ = std::move(geometry);
  has_values_ = false;
  if (!vertex_array_) vertex_array_ = make_vertex_array();
  points_ = make_buffer(std::span<const LineVertex>(geometry_.vertices));
  values_ = make_buffer(std::span<const float>());
  upload_segments();
  sorted_ = false;
}

void LineSet::set_values(std::span<const float> coordinates) {
  PALPATE_CHECK(coordinates.size() == geometry_.vertices.size());
  values_ = make_buffer(coordinates);
  has_values_ = true;
}

void LineSet::upload_segments() {
  std::vector<std::uint32_t> corners;
  corners.reserve(6 * geometry_.segments.size());
  for (const std::uint32_t s : geometry_.segments) {
    const std::uint32_t a = 2 * s;
    corners.insert(corners.end(), {a, a + 1, a + 2, a + 2, a + 1, a + 3});
  }
  indices_ = make_buffer(std::span<const std::uint32_t>(corners));
  glVertexArrayElementBuffer(vertex_array_.name(), indices_.name());
}

void LineSet::draw(const LineDraw& how) {
  if (geometry_.segments.empty()) return;
  const bool transparent = how.opacity < 1.0F;
  if (transparent && !(sorted_ && sorted_along_ == how.back)) {
    sort_back_to_front(geometry_.segments, geometry_.vertices, how.back);
    upload_segments();
    sorted_ = true;
    sorted_along_ = how.back;
  }

  glUniform1f(kWidth, how.width);
  glUniform1f(kHaloWidth, transparent ? 0.0F : how.halo_width);
  glUniform1f(kMinWidth, how.min_width);
  glUniform1i(kHasValues, has_values_ ? 1 : 0);
  glUniform1i(kColoring, static_cast<GLint>(how.coloring));
  glUniform4f(kLineColor, how.color.r, how.color.g, how.color.b, how.opacity);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kPointsBinding, points_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kValuesBinding, values_.name());
  glBindVertexArray(vertex_array_.name());

  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(transparent ? GL_FALSE : GL_TRUE);
  if (transparent) {
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  } else {
    glDisable(GL_BLEND);
  }
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(6 * geometry_.segments.size()), GL_UNSIGNED_INT, nullptr);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

}  // namespace palpate
