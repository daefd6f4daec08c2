#include "common/render/glyph/probe_pass.h"

#include <algorithm>
#include <span>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/render/color/palette.h"
#include "common/render/line/line_geometry.h"
#include "common/render/scene_parts.h"
#include "common/render/scene_view.h"

namespace palpate {
namespace {

// The piece of the path that point i lies in, as the half-open range of its points.
struct Piece {
  std::size_t begin = 0, end = 0;
};

template <class Visit>
void for_each_piece(const ProbePath& path, std::size_t count, const Visit& visit) {
  const auto starts = path.pieces();
  for (std::size_t k = 0; k < starts.size() && starts[k] < count; ++k) {
    visit(Piece{starts[k], k + 1 < starts.size() ? std::min(starts[k + 1], count) : count});
  }
}

// A copy of the first `used` bytes in a buffer that has room for more.
GlBuffer grown(const GlBuffer& old, std::size_t used, std::size_t bytes) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  GlBuffer buffer(name);
  glNamedBufferStorage(name, static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_STORAGE_BIT);
  if (used > 0) glCopyNamedBufferSubData(old.name(), name, 0, 0, static_cast<GLsizeiptr>(used));
  return buffer;
}

template <class T>
void upload(const GlBuffer& buffer, std::size_t first, std::span<const T> values) {
  glNamedBufferSubData(buffer.name(), static_cast<GLintptr>(first * sizeof(T)),
                       static_cast<GLsizeiptr>(values.size_bytes()), values.data());
}

bool same_frame(const SceneFrame& a, const SceneFrame& b) {
  return a.center == b.center && a.exponent == b.exponent;
}

// Half widths: a line at the probe lies upon one of the scene that runs along the same curve, as the tube
// that it looks like would; the path, which is narrower, upon the followed line.
constexpr float kLineLift = 1.0F, kPathLift = 2.4F;
// What hides the followed line lies before it by more than that: the path upon it does not.
constexpr float kHiddenLift = 2.5F;

// Halos as wide as half the line, but never thinner than the eye sees nor so wide that they eat neighbours.
float halo_of(float width, float unit) { return std::clamp(0.5F * width, 1.0F, 3.0F * unit + 1.0F); }

// What lies before the nearest or behind the farthest clip plane is drawn at that plane's depth: the
// probe may leave the box that the picture was fitted to.
class DepthClamp {
 public:
  DepthClamp() { glEnable(GL_DEPTH_CLAMP); }
  ~DepthClamp() { glDisable(GL_DEPTH_CLAMP); }
  DepthClamp(const DepthClamp&) = delete;
  DepthClamp& operator=(const DepthClamp&) = delete;
};

LineDraw::Coloring coloring_of(const LineStyle& style, bool has_values) {
  if (style.color_by == ColorBy::kDirection) return LineDraw::Coloring::kDirection;
  if (style.color_by == ColorBy::kUniform || !has_values) return LineDraw::Coloring::kOneColor;
  return LineDraw::Coloring::kMap;
}

}  // namespace

void LineTrail::reserve(std::size_t count) {
  constexpr std::size_t kFirstRoom = 1024;
  if (count <= capacity_) return;
  const std::size_t room = std::max({count, 2 * capacity_, kFirstRoom});
  points_ = grown(points_, size_ * sizeof(LineVertex), room * sizeof(LineVertex));
  values_ = grown(values_, size_ * sizeof(float), room * sizeof(float));
  capacity_ = room;
}

bool LineTrail::extend(const std::shared_ptr<const ProbePath>& path, std::size_t count,
                       const SceneFrame& frame, const ValueRange& range) {
  count = path ? std::min(count, path->size()) : 0;
  const bool anew = path != path_ || frame.center != frame_.center || frame.exponent != frame_.exponent ||
                    range != range_ || count < size_;
  if (anew) {
    path_ = path;
    frame_ = frame;
    range_ = range;
    size_ = 0;
    above_range_ = false;
  }
  if (count == size_) return anew;
  reserve(count);
  if (!vertex_array_) vertex_array_ = make_vertex_array();

  // From the last point that is there: its direction changes with the next one.
  const std::size_t from = settled();
  for_each_piece(*path, count, [&](const Piece& piece) {
    if (piece.end <= from) return;
    const std::size_t first = std::max(piece.begin, from);
    // The point before gives the direction at `first`.
    const std::size_t context = first > piece.begin ? first - 1 : first;
    const auto positions = path->positions().subspan(context, piece.end - context);
    const LineGeometry geometry = make_line_geometry({{positions.begin(), positions.end()}}, frame);
    upload(points_, first, std::span<const LineVertex>(geometry.vertices).subspan(first - context));
  });
  const auto forces = path->forces().subspan(from, count - from);
  const std::vector<float> places = map_coordinates({forces.begin(), forces.end()}, LineStyle{}, range);
  upload(values_, from, std::span<const float>(places));
  above_range_ = above_range_ ||
                 std::any_of(forces.begin(), forces.end(), [&](double force) { return force > range.upper; });
  size_ = count;
  return anew;
}

void LineTrail::draw(const LineDraw& how, std::size_t first, std::size_t last) const {
  if (size_ == 0 || first >= last) return;
  PALPATE_CHECK(last < size_);
  std::vector<GLint> starts;
  std::vector<GLsizei> counts;
  for_each_piece(*path_, size_, [&](const Piece& piece) {
    const std::size_t a = std::max(piece.begin, first), b = std::min(piece.end, last + 1);
    if (b < a + 2) return;
    // Each point gives two vertices; those of a strip are the corners of the ribbon in turn.
    starts.push_back(static_cast<GLint>(2 * a));
    counts.push_back(static_cast<GLsizei>(2 * (b - a)));
  });
  if (starts.empty()) return;
  detail::begin_lines(how, true);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, detail::kLinePoints, points_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, detail::kLineValues, values_.name());
  glBindVertexArray(vertex_array_.name());
  glMultiDrawArrays(GL_TRIANGLE_STRIP, starts.data(), counts.data(), static_cast<GLsizei>(starts.size()));
  detail::end_lines();
}

bool ProbePass::update(const SceneView& view, const SceneFrame& frame, const ValueRange& range) {
  const ProbeView& probe = *view.probe;
  const bool other_frame = !same_frame(frame, frame_);
  const bool other_colors = range != range_ || style_ != view.style;
  if (probe.followed != shown_followed_ || other_frame || other_colors) upload_followed(view, frame, range);
  if (probe.seeds != shown_seeds_ || other_frame || other_colors) upload_seeds(view, frame, range);
  if (probe.drawn_lines != shown_kept_ || other_frame) upload_cached(view, frame);
  frame_ = frame;
  range_ = range;
  style_ = view.style;
  glyphs_ = make_probe_glyphs(view, frame, range);
  return trail_.extend(probe.path.points, probe.path.count, frame, force_range(probe));
}

void ProbePass::upload_followed(const SceneView& view, const SceneFrame& frame, const ValueRange& range) {
  shown_followed_ = view.probe->followed;
  followed_has_values_ = false;
  if (!shown_followed_) return;
  const FollowedLine& line = *shown_followed_;
  followed_.set_geometry(make_line_geometry({line.points}, frame));
  followed_has_values_ = line.values.size() == line.points.size() && colored_by_value(view.style);
  if (followed_has_values_) followed_.set_values(map_coordinates(line.values, view.style, range));
}

void ProbePass::upload_seeds(const SceneView& view, const SceneFrame& frame, const ValueRange& range) {
  shown_seeds_ = view.probe->seeds;
  if (!shown_seeds_ || !shown_seeds_->lines) return;
  const LineStyle style = style_of(*shown_seeds_, view.style);
  const std::vector<Line>& lines = *shown_seeds_->lines;
  seeds_.set_geometry(make_line_geometry(lines, frame));
  if (colored_by_value(style)) seeds_.set_values(map_coordinates(line_values(lines, style), style, range));
}

void ProbePass::upload_cached(const SceneView& view, const SceneFrame& frame) {
  shown_kept_ = view.probe->drawn_lines;
  kept_.clear();
  if (!shown_kept_) return;
  for (const DrawnLine& kept : *shown_kept_) {
    kept_.emplace_back();
    kept_.back().set_geometry(kept.line ? make_line_geometry({*kept.line}, frame) : LineGeometry{});
  }
}

Rgb ProbePass::kept_color(std::size_t i) const {
  const DrawnLine& kept = (*shown_kept_)[i];
  return kept.color.value_or(cached_color(kept.number));
}

void ProbePass::draw_path(LineProgram& program, const SceneView& view, float unit, std::size_t first,
                          std::size_t last) const {
  const DepthClamp clamp;
  program.use(view.probe->style.force_map);
  LineDraw how;
  how.width = static_cast<float>(view.probe->style.path_width) * unit;
  how.halo_width = halo_of(how.width, unit);
  how.fading = 0.0F;
  how.lift = kPathLift;
  trail_.draw(how, first, last);
}

std::size_t ProbePass::draw_settled_path(LineProgram& program, const SceneView& view, float unit,
                                         std::size_t first) const {
  const std::size_t last = std::max<std::size_t>(trail_.settled(), 1) - 1;
  draw_path(program, view, unit, first, last);
  return std::max(first, last);
}

void ProbePass::draw_path_end(LineProgram& program, const SceneView& view, float unit) const {
  if (trail_.size() < 2) return;
  draw_path(program, view, unit, trail_.size() - 2, trail_.size() - 1);
}

// With s = see_through, C and a colour and opacity of the volume before it and P its own colour, this makes
// C + (1 - a) P, the volume over it, into (1 - s) C + (1 - (1 - s) a) P: the share of 1 - s that nearer
// things have of what shines through them.
void ProbePass::draw_through(LineProgram& program, const SceneView& view, const LineDraw& base, float unit) {
  const auto see_through = static_cast<float>(std::clamp(view.probe->style.see_through, 0.0, 1.0));
  if (!(see_through > 0.0F)) return;
  const DepthClamp clamp;
  LineDraw how = base;
  how.fading = 0.0F;
  how.min_width = 1.0F;
  how.lift = kLineLift;
  how.opacity = see_through;
  how.seen_again = true;
  how.width = static_cast<float>(view.probe->style.kept_width) * unit;
  how.coloring = LineDraw::Coloring::kOneColor;
  program.use(ColorMap::kSequential);
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    how.color = kept_color(i);
    kept_[i].draw(how);
  }
  if (shown_followed_) {
    how.width = static_cast<float>(view.probe->style.followed_width) * unit;
    how.coloring = coloring_of(view.style, followed_has_values_);
    how.color = palette_of(view.background).plain_line;
    program.use(color_map_of(view.style));
    followed_.draw(how);
  }
  arrow_pass_.draw(glyphs_.arrows, see_through, GlyphPart::kSeenAgain);
  tensor_mesh_.draw(glyphs_.tensors, true, see_through, GlyphPart::kSeenAgain);
  sphere_pass_.draw(glyphs_.spheres, 0.0F, see_through, GlyphPart::kSeenAgain);
}

void ProbePass::draw(LineProgram& program, const SceneView& view, const LineDraw& base, float unit) {
  const ProbeView& probe = *view.probe;
  const Palette& colors = palette_of(view.background);
  const DepthClamp clamp;
  const auto see_through = static_cast<float>(std::clamp(probe.style.see_through, 0.0, 1.0));
  LineDraw how = base;
  how.fading = 0.0F;
  how.min_width = 1.0F;
  how.lift = kLineLift;
  const auto set_width = [&](double thousandths) {
    how.width = static_cast<float>(thousandths) * unit;
    how.halo_width = halo_of(how.width, unit);
  };

  // What is hidden of a line shines through faintly, then the rest is drawn over it.
  const auto draw_hidden = [&](LineSet& line) {
    if (!(see_through > 0.0F)) return;
    how.hidden_part = true;
    how.lift = kHiddenLift;
    how.opacity = see_through;
    line.draw(how);
    how.hidden_part = false;
    how.lift = kLineLift;
    how.opacity = 1.0F;
  };

  // Kept lines, then the followed one: both opaque.
  how.opacity = 1.0F;
  set_width(probe.style.kept_width);
  how.coloring = LineDraw::Coloring::kOneColor;
  program.use(ColorMap::kSequential);
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    how.color = kept_color(i);
    draw_hidden(kept_[i]);
    kept_[i].draw(how);
  }
  if (shown_followed_) {
    program.use(color_map_of(view.style));
    set_width(probe.style.followed_width);
    how.coloring = coloring_of(view.style, followed_has_values_);
    how.color = colors.plain_line;
    draw_hidden(followed_);
    how.halo_color = colors.ink;
    how.halo_width = std::max(1.0F, 1.6F * unit);
    followed_.draw(how);
    how.halo_color.reset();
  }

  arrow_pass_.draw(glyphs_.arrows, see_through);
  tensor_mesh_.draw(glyphs_.tensors, true, see_through);
  sphere_pass_.draw(glyphs_.spheres, std::max(1.0F, 1.2F * unit), see_through);

  if (shown_seeds_ && shown_seeds_->lines) {
    program.use(color_map_of(view.style));
    set_width(shown_seeds_->width);
    how.coloring = coloring_of(style_of(*shown_seeds_, view.style), true);
    how.color = colors.plain_line;
    seeds_.draw(how);
  }
}

}  // namespace palpate
