#include "common/render/glyph/probe_glyphs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "common/math/symmetric3.h"
#include "common/render/color/palette.h"
#include "common/render/line/line_geometry.h"
#include "common/render/scene_view.h"

namespace palpate {
namespace {

// Longest vector icon, in lengths at the reference speed: it must not cross the whole picture.
constexpr double kLongestArrow = 3.0;
// Thousandths of the picture's height: the head of an arrow, and the bars of rakes and planes.
constexpr double kHeadLength = 24.0, kBarWidth = 3.0;
// Shares: of the head in a short arrow, of the head's radius in its length, of the shaft in that.
constexpr double kHeadShare = 0.45, kHeadSlope = 0.36, kShaftShare = 0.36;

// As the path and the colour bar have it; without a range of its own that is the tension.
Rgb band_color(const ProbeView& probe) {
  const ValueRange range = force_range(probe);
  const double t = (probe.force - range.lower) / (range.upper - range.lower);
  return map_color(probe.style.force_map, t);
}

// The glyph that stands for the probe's tensor, or none.
std::optional<TensorGlyph> tensor_glyph(const SceneView& view, const SceneFrame& frame) {
  const ProbeView& probe = *view.probe;
  if (!probe.tensor || !is_finite(probe.proxy)) return std::nullopt;
  const double largest = symmetric_eigenvalues(*probe.tensor).x;
  if (!(largest > 0.0) || !std::isfinite(largest)) return std::nullopt;
  const bool chosen = view.tensors && view.tensors->glyphs != GlyphShape::kNone;
  const double reach = 0.5e-3 * probe.style.tensor_length * view.camera.view_height;
  return make_glyph(*probe.tensor, chosen ? view.tensors->glyphs : GlyphShape::kSuperquadric,
                    view.tensors ? view.tensors->color : TensorColor::kDirection, probe.proxy, reach, frame);
}

class Builder {
 public:
  Builder(const SceneView& view, const SceneFrame& frame)
      : frame_(frame), thousandth_(1e-3 * view.camera.view_height * power_of_two(-frame.exponent)) {}

  /// @param size diameter in thousandths of the picture's height.
  void sphere(const Vec3& x, double size, const Rgb& color) {
    sphere_of_radius(x, 0.5 * size * thousandth_, color);
  }
  /// @param radius in data units.
  void data_sphere(const Vec3& x, double radius, const Rgb& color) {
    sphere_of_radius(x, radius * power_of_two(-frame_.exponent), color);
  }

  /// @param width in thousandths of the picture's height, as a function of the length in the same.
  template <class Width>
  void tube(const Vec3& from, const Vec3& to, const Width& width, const Rgb& color) {
    const Vec3 a = frame_.scene_from_data(from), step = frame_.scene_from_data(to) - a;
    const double length = glm::length(step);
    if (!(length > 0.0) || !std::isfinite(length)) return;
    glyphs.arrows.push_back(
        {.origin = Vec3f(a),
         .shaft_radius = static_cast<float>(0.5 * width(length / thousandth_) * thousandth_),
         .axis = Vec3f(step / length),
         .shaft_length = static_cast<float>(length),
         .color = color});
  }

  /// @param length in thousandths of the picture's height.
  void arrow(const Vec3& from, const Vec3& direction, double length, const Rgb& color) {
    const double head = std::min(kHeadLength, kHeadShare * length);
    const double radius = kHeadSlope * head;
    glyphs.arrows.push_back({.origin = Vec3f(frame_.scene_from_data(from)),
                             .shaft_radius = static_cast<float>(kShaftShare * radius * thousandth_),
                             .axis = Vec3f(direction),
                             .shaft_length = static_cast<float>((length - head) * thousandth_),
                             .head_radius = static_cast<float>(radius * thousandth_),
                             .head_length = static_cast<float>(head * thousandth_),
                             .color = color});
  }

  ProbeGlyphs glyphs;

 private:
  void sphere_of_radius(const Vec3& x, double radius, const Rgb& color) {
    if (!is_finite(x) || !(radius > 0.0) || !std::isfinite(radius)) return;
    glyphs.spheres.push_back(
        {.center = Vec3f(frame_.scene_from_data(x)), .radius = static_cast<float>(radius), .color = color});
  }

  SceneFrame frame_;
  double thousandth_;  // of the picture's height, scene frame
};

void add_balls(Builder& builder, const SceneView& view, const ValueRange& range, const Palette& colors) {
  const FollowedLine& line = *view.probe->followed;
  std::vector<float> places;
  if (line.ball_values.size() == line.balls.size() && colored_by_value(view.style)) {
    places = map_coordinates(line.ball_values, view.style, range);
  }
  const ColorMap map = color_map_of(view.style);
  for (std::size_t i = 0; i < line.balls.size(); ++i) {
    const Rgb color = places.empty() ? colors.plain_line : map_color(map, places[i]);
    if (line.ball_radius > 0.0) {
      builder.data_sphere(line.balls[i], line.ball_radius, color);
    } else {
      builder.sphere(line.balls[i], view.probe->style.ball_size, color);
    }
  }
}

void add_seeds(Builder& builder, const ProbeView& probe, const Palette& colors) {
  const LocalSeeds& seeds = *probe.seeds;
  const Vec3 a = seeds.origin;
  std::vector<Vec3> corners;
  if (seeds.shape == SeedShape::kRake) corners = {a, a + seeds.u};
  if (seeds.shape == SeedShape::kPlane) corners = {a, a + seeds.u, a + seeds.u + seeds.v, a + seeds.v};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    builder.sphere(corners[i], probe.style.handle_size, colors.tool);
    if (i == 1 && corners.size() == 2) break;  // a rake has one bar
    builder.tube(
        corners[i], corners[(i + 1) % corners.size()], [](double) { return kBarWidth; }, colors.tool);
  }
  for (const Vec3& seed : seeds.seeds) builder.sphere(seed, probe.style.seed_size, colors.ink);
}

// The proxies of a chain beside the one that stands for it.
void add_links(Builder& builder, const ProbeView& probe, const Palette& colors) {
  constexpr double kLinkWidth = 2.5;  // thousandths of the picture's height
  for (std::size_t i = 0; i < probe.links.size(); ++i) {
    if (probe.links[i] != probe.proxy) builder.sphere(probe.links[i], probe.style.link_size, colors.proxy);
    if (i > 0)
      builder.tube(
          probe.links[i - 1], probe.links[i], [](double) { return kLinkWidth; }, colors.proxy);
  }
}

}  // namespace

ProbeGlyphs make_probe_glyphs(const SceneView& view, const SceneFrame& frame, const ValueRange& range) {
  const ProbeView& probe = *view.probe;
  const Palette& colors = palette_of(view.background);
  Builder builder(view, frame);
  if (probe.followed) add_balls(builder, view, range, colors);
  if (probe.seeds) add_seeds(builder, probe, colors);

  if (const auto glyph = tensor_glyph(view, frame)) {
    builder.glyphs.tensors.push_back(*glyph);
  } else {
    builder.sphere(probe.proxy, probe.style.proxy_size, colors.proxy);
  }
  builder.sphere(probe.probe, probe.style.probe_size, colors.ink);
  add_links(builder, probe, colors);
  if (is_finite(probe.probe) && is_finite(probe.proxy) && probe.force_cap > 0.0) {
    builder.tube(
        probe.probe, probe.proxy,
        [&](double stretch) {
          return probe.style.band_width / std::sqrt(1.0 + stretch / probe.style.band_rest);
        },
        band_color(probe));
  }
  if (is_finite(probe.probe) && probe.reference_speed > 0.0) {
    const Vec3 ratio = probe.velocity / probe.reference_speed;
    const double size = glm::length(ratio);
    if (size > 0.0 && std::isfinite(size)) {
      const double length = probe.style.arrow_length * std::min(size, kLongestArrow);
      builder.arrow(probe.probe, ratio / size, length, colors.ink);
    }
  }
  return builder.glyphs;
}

}  // namespace palpate
