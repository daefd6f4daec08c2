#include "common/render/line/line_layers.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/math/power_of_two.h"
#include "common/render/color/color_map.h"
#include "common/render/color/palette.h"
#include "common/render/gl/program.h"
#include "common/render/line/line_geometry.h"
#include "common/render/scene_view.h"

namespace palpate {
namespace {

bool same_colors(const LineStyle& a, const LineStyle& b) {
  return a.color_by == b.color_by && a.array == b.array && is_logarithmic(a) == is_logarithmic(b) &&
         color_map_of(a) == color_map_of(b) && a.range == b.range && a.usual == b.usual;
}

// Of shaders/line/layers.glsl.
constexpr GLuint kFragments = 3, kHeads = 4;
constexpr std::size_t kFragmentBytes = 16, kCountBytes = 4;

std::size_t most_fragments() {
  constexpr std::size_t kMostBytes = std::size_t{1} << 29U;  // more takes other things' memory
  GLint64 bytes = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
  return (std::min(as_size(bytes), kMostBytes) - kCountBytes) / kFragmentBytes;
}

GlBuffer make_room(std::size_t bytes) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  glNamedBufferStorage(name, static_cast<GLsizeiptr>(bytes), nullptr, 0);
  return GlBuffer(name);
}

void clear(const GlBuffer& buffer, std::size_t bytes) {
  glClearNamedBufferSubData(buffer.name(), GL_R32UI, 0, static_cast<GLsizeiptr>(bytes), GL_RED_INTEGER,
                            GL_UNSIGNED_INT, nullptr);
}

}  // namespace

void ColoredLines::set_geometry(const std::vector<Line>* lines, const SceneFrame& frame) {
  lines_.set_geometry(lines != nullptr ? make_line_geometry(*lines, frame) : LineGeometry{});
  shown_style_.reset();
  shown_lens_style_.reset();
}

bool ColoredLines::update_colors(const SceneView& view) {
  const bool other_lens = update_lens_colors(view);
  if (shown_style_ && same_colors(*shown_style_, view.style)) return other_lens;
  const ValueRange lens_range = legend_.lens_range;
  legend_ = {};
  legend_.lens_range = lens_range;
  if (view.lines) {
    const std::vector<double> values = line_values(*view.lines, view.style);
    legend_.range = value_range(*view.lines, view.style);
    legend_.values_below =
        std::any_of(values.begin(), values.end(), [&](double v) { return v < legend_.range.lower; });
    legend_.values_above =
        std::any_of(values.begin(), values.end(), [&](double v) { return v > legend_.range.upper; });
    for (const Line& line : *view.lines) ++legend_.ends[as_size(line.end)];
    lines_.set_values(map_coordinates(values, view.style, legend_.range));
  } else {
    legend_.range = view.style.range.value_or(ValueRange{});  // of surfaces alone
  }
  shown_style_ = view.style;
  return true;
}

bool ColoredLines::update_lens_colors(const SceneView& view) {
  if (!view.color_lens || !view.lines) {
    if (shown_lens_style_) lines_.set_lens_values({});
    shown_lens_style_.reset();
    return false;
  }
  const LineStyle& style = view.color_lens->style;
  if (shown_style_ && shown_lens_style_ && same_colors(*shown_lens_style_, style)) return false;
  legend_.lens_range = value_range(*view.lines, style);
  const std::vector<double> values = line_values(*view.lines, style);
  lines_.set_lens_values(map_coordinates(values, style, legend_.lens_range));
  shown_lens_style_ = style;
  return true;
}

void ColoredLines::draw(LineProgram& program, const SceneView& view, const SceneFrame& frame,
                        const LineDraw& base, float unit) {
  std::optional<ColorMap> lens_map;
  if (view.color_lens) lens_map = color_map_of(view.color_lens->style);
  program.use(color_map_of(view.style), lens_map);
  LineDraw how = base;
  if (view.color_lens) {
    how.lens_center = Vec3f(frame.scene_from_data(view.color_lens->center));
    how.lens_radius = static_cast<float>(view.color_lens->radius * power_of_two(-frame.exponent));
  }
  how.coloring = view.style.color_by == ColorBy::kDirection ? LineDraw::Coloring::kDirection
                 : view.style.color_by == ColorBy::kUniform ? LineDraw::Coloring::kOneColor
                                                            : LineDraw::Coloring::kMap;
  how.color = palette_of(view.background).plain_line;
  how.width = static_cast<float>(view.style.width) * unit;
  how.min_width = 1.0F;
  // Half the line's width, but never thinner than the eye sees nor so wide that it eats neighbours.
  how.halo_width = view.style.halo ? std::clamp(0.5F * how.width, 1.0F, 3.0F * unit + 1.0F) : 0.0F;
  how.opacity = static_cast<float>(std::clamp(view.style.opacity, 0.0, 1.0));
  how.clearing = static_cast<float>(std::clamp(view.style.clearing, 0.0, 1.0));
  how.dimming = static_cast<float>(std::clamp(view.style.dimming, 0.0, 1.0));
  lines_.draw(how);
}

void LineLayers::reserve(std::size_t fragments) {
  if (fragments <= room_) return;
  room_ = std::min(std::bit_ceil(fragments), most_fragments());
  fragments_ = make_room(kCountBytes + kFragmentBytes * room_);
}

bool LineLayers::collect(int width, int height, const std::function<void()>& draw) {
  PALPATE_CHECK(width > 0 && height > 0);
  const std::size_t pixels = as_size(width) * as_size(height);
  if (pixels != pixels_) heads_ = make_room(sizeof(std::uint32_t) * pixels);
  pixels_ = pixels;
  constexpr std::size_t kFirstRoom = std::size_t{1} << 16U;
  reserve(kFirstRoom);
  for (;;) {
    clear(heads_, sizeof(std::uint32_t) * pixels);
    clear(fragments_, kCountBytes);
    bind();
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    draw();
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    std::uint32_t count = 0;
    glGetNamedBufferSubData(fragments_.name(), 0, sizeof count, &count);
    if (count <= room_) break;
    if (room_ == most_fragments()) return false;
    reserve(count);
  }

  if (!sort_) sort_ = compile_compute("line/sort_layers.comp");
  glUseProgram(sort_.name());
  constexpr std::size_t kGroup = 64;  // local_size_x of the shader
  glDispatchCompute(static_cast<GLuint>((pixels + kGroup - 1) / kGroup), 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  return true;
}

void LineLayers::bind() const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kFragments, fragments_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kHeads, heads_.name());
}

}  // namespace palpate
