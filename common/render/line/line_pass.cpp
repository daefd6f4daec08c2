#include "common/render/line/line_pass.h"

#include <string>

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
  kLift = 9,
  kLens = 10,
  kClearing = 11
};
constexpr GLuint kTableUnit = 0, kLensTableUnit = 1;

GlProgram compile_lines() { return compile_program("line/line.vert", "line/line.frag"); }

GlProgram compile_layers() {
  const std::vector<std::string> defines{"LAYERS"};
  GlProgram program = compile_program("line/line.vert", "line/line.frag", shader_files(), defines);
  label_object(GpuObject::Kind::kProgram, program.name(), "line/line.frag, as layers");
  return program;
}

}  // namespace

namespace detail {

void begin_lines(const LineDraw& how, bool has_values) {
  const bool transparent = how.transparent();
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
  glUniform1f(kClearing, has_values ? how.clearing : 0.0F);
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

void LineProgram::use(ColorMap map, std::optional<ColorMap> lens_map) {
  if (!program_) program_ = into_ == Into::kLayers ? compile_layers() : compile_lines();
  glUseProgram(program_.name());
  tables_.bind(map, kTableUnit);
  tables_.bind(lens_map.value_or(map), kLensTableUnit);
}

void LineSet::set_geometry(LineGeometry geometry) {
  geometry_ = std::move(geometry);
  coordinates_.clear();
  arrangement_ = {};
  if (!vertex_array_) vertex_array_ = make_vertex_array();
  points_ = make_buffer(std::span<const LineVertex>(geometry_.vertices));
  values_ = make_buffer(std::span<const float>());
  set_lens_values({});
}

void LineSet::set_values(std::vector<float> coordinates) {
  PALPATE_CHECK(coordinates.size() == geometry_.vertices.size());
  coordinates_ = std::move(coordinates);
  arrangement_ = {};
  values_ = make_buffer(std::span<const float>(coordinates_));
}

void LineSet::set_lens_values(std::span<const float> coordinates) {
  PALPATE_CHECK(coordinates.empty() || coordinates.size() == geometry_.vertices.size());
  has_lens_values_ = !coordinates.empty();
  lens_values_ = make_buffer(coordinates);
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
  // What shines through is too faint for its order to matter, what is seen again has its depths: no second
  // arrangement for them.
  const bool transparent = how.transparent() && !how.hidden_part && !how.seen_again;
  // Points are left out by the first values alone: with others all are there.
  arrange({has_lens_values_ ? 0.0 : how.tolerance, transparent, transparent ? how.back : Vec3f{0.0F}});

  detail::begin_lines(how, !coordinates_.empty());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, detail::kLinePoints, points_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, detail::kLineValues, values_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, detail::kLineLensValues, lens_values_.name());
  glUniform4f(kLens, how.lens_center.x, how.lens_center.y, how.lens_center.z,
              has_lens_values_ ? how.lens_radius : 0.0F);
  glBindVertexArray(vertex_array_.name());
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(corner_count_), GL_UNSIGNED_INT, nullptr);
  glUniform4f(kLens, 0.0F, 0.0F, 0.0F, 0.0F);  // trails have none
  detail::end_lines();
}

}  // namespace palpate
