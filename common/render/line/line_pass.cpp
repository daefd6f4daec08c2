#include "common/render/line/line_pass.h"

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/render/gl/gpu_objects.h"
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
  kLineColor = 5,
  kFading = 6,
  kHaloColor = 7,
  kDimming = 8,
  kLift = 9
};
constexpr GLuint kTableUnit = 0;

GlTexture make_table_texture(ColorMap map) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  GlTexture texture(name);
  label_object(GpuObject::Kind::kTexture, name, "colours of lines");
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

namespace detail {

void begin_lines(const LineDraw& how, bool has_values) {
  const bool transparent = how.opacity < 1.0F;
  const Rgb rim = how.halo_color.value_or(Rgb{0.0F});
  glUniform1f(kWidth, how.width);
  glUniform1f(kHaloWidth, transparent ? 0.0F : how.halo_width);
  glUniform1f(kMinWidth, how.min_width);
  glUniform1i(kHasValues, has_values ? 1 : 0);
  glUniform1i(kColoring, static_cast<GLint>(how.coloring));
  glUniform4f(kLineColor, how.color.r, how.color.g, how.color.b, how.opacity);
  glUniform1f(kFading, how.fading);
  glUniform1f(kDimming, how.dimming);
  glUniform1f(kLift, how.lift);
  glUniform4f(kHaloColor, rim.r, rim.g, rim.b, how.halo_color ? 1.0F : 0.0F);

  glEnable(GL_DEPTH_TEST);
  glDepthFunc(how.hidden_part ? GL_GREATER : GL_LEQUAL);
  glDepthMask(transparent ? GL_FALSE : GL_TRUE);
  if (transparent) {
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  } else {
    glDisable(GL_BLEND);
  }
}

void end_lines() {
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

}  // namespace detail

void LineProgram::use(ColorMap map) {
  if (!program_) program_ = compile_program("line/line.vert", "line/line.frag");
  GlTexture& table = tables_[static_cast<std::size_t>(map)];
  if (!table) table = make_table_texture(map);
  glUseProgram(program_.name());
  glBindTextureUnit(kTableUnit, table.name());
}

void LineSet::set_geometry(LineGeometry geometry) {
  geometry_ = std::move(geometry);
  coordinates_.clear();
  arrangement_ = {};
  if (!vertex_array_) vertex_array_ = make_vertex_array();
  points_ = make_buffer(std::span<const LineVertex>(geometry_.vertices));
  values_ = make_buffer(std::span<const float>());
}

void LineSet::set_values(std::vector<float> coordinates) {
  PALPATE_CHECK(coordinates.size() == geometry_.vertices.size());
  coordinates_ = std::move(coordinates);
  arrangement_ = {};
  values_ = make_buffer(std::span<const float>(coordinates_));
}

void LineSet::arrange(const Arrangement& wanted) {
  if (wanted == arrangement_) return;
  if (wanted.tolerance != arrangement_.tolerance) {
    simplified_ = simplify(geometry_, coordinates_, wanted.tolerance);
  }
  std::vector<LineSegment> sorted;
  if (wanted.sorted) {
    sorted = simplified_;
    sort_back_to_front(sorted, geometry_.vertices, wanted.along);
  }
  std::vector<std::uint32_t> corners;
  corners.reserve(6 * simplified_.size());
  for (const LineSegment& s : wanted.sorted ? sorted : simplified_) {
    const std::uint32_t a = 2 * s.first, b = 2 * s.last;
    corners.insert(corners.end(), {a, a + 1, b, b, a + 1, b + 1});
  }
  corner_count_ = corners.size();
  indices_ = make_buffer(std::span<const std::uint32_t>(corners));
  glVertexArrayElementBuffer(vertex_array_.name(), indices_.name());
  arrangement_ = wanted;
}

void LineSet::draw(const LineDraw& how) {
  if (geometry_.segments.empty()) return;
  // What shines through is too faint for its order to matter: no second arrangement for it.
  const bool transparent = how.opacity < 1.0F && !how.hidden_part;
  arrange({how.tolerance, transparent, transparent ? how.back : Vec3f{0.0F}});

  detail::begin_lines(how, !coordinates_.empty());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, detail::kLinePoints, points_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, detail::kLineValues, values_.name());
  glBindVertexArray(vertex_array_.name());
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(corner_count_), GL_UNSIGNED_INT, nullptr);
  detail::end_lines();
}

}  // namespace palpate
