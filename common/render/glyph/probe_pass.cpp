#include "common/render/glyph/probe_pass.h"

#include <algorithm>
#include <span>

#include <epoxy/gl.h>

#include "common/render/color/palette.h"
#include "common/render/line/line_geometry.h"
#include "common/render/line/line_values.h"

namespace palpate {
namespace {

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
  const LineStyle& style = shown_seeds_->style;
  const std::vector<Line>& lines = *shown_seeds_->lines;
  const bool like_scene =
      !style.range && style.color_by == view.style.color_by && view.lines && !view.lines->empty();
  const ValueRange own = like_scene ? range : value_range(lines, style);
  seeds_.set_geometry(make_line_geometry(lines, frame));
  seeds_.set_values(map_coordinates(line_values(lines, style), style, own));
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
  if (shown_followed_) {
    LineDraw how = base;
    how.fading = 0.0F;
    how.min_width = 1.0F;
    how.lift = kLineLift;
    how.width = static_cast<float>(view.probe->style.followed_width) * unit;
    how.coloring = coloring_of(view.style, followed_has_values_);
    how.color = palette_of(view.background).plain_line;
    how.opacity = see_through;
    how.seen_again = true;
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

  // Kept lines, then the followed one: both opaque.
  how.opacity = 1.0F;
  set_width(probe.style.kept_width);
  how.coloring = LineDraw::Coloring::kOneColor;
  program.use(ColorMap::kSequential);
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    const DrawnLine& kept = (*shown_kept_)[i];
    how.color = kept.color.value_or(cached_color(kept.number));
    kept_[i].draw(how);
  }
  if (shown_followed_) {
    program.use(color_map_of(view.style));
    set_width(probe.style.followed_width);
    how.coloring = coloring_of(view.style, followed_has_values_);
    how.color = colors.plain_line;
    if (see_through > 0.0F) {
      how.hidden_part = true;
      how.lift = kHiddenLift;
      how.opacity = see_through;
      followed_.draw(how);
      how.hidden_part = false;
      how.lift = kLineLift;
      how.opacity = 1.0F;
    }
    how.halo_color = colors.ink;
    how.halo_width = std::max(1.0F, 1.6F * unit);
    followed_.draw(how);
    how.halo_color.reset();
  }

  arrow_pass_.draw(glyphs_.arrows, see_through);
  tensor_mesh_.draw(glyphs_.tensors, true, see_through);
  sphere_pass_.draw(glyphs_.spheres, std::max(1.0F, 1.2F * unit), see_through);

  // Lines of the local seeds may be transparent: they come last.
  if (shown_seeds_ && shown_seeds_->lines) {
    const LineStyle& style = shown_seeds_->style;
    program.use(color_map_of(style));
    set_width(style.width);
    if (!style.halo) how.halo_width = 0.0F;
    how.coloring = coloring_of(style, true);
    how.color = colors.plain_line;
    how.opacity = static_cast<float>(std::clamp(style.opacity, 0.0, 1.0));
    how.dimming = static_cast<float>(std::clamp(style.dimming, 0.0, 1.0));
    seeds_.draw(how);
  }
}

}  // namespace palpate
