#include "common/compose/appearance.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/compose/volume_scene.h"

namespace palpate {
namespace {

constexpr std::array kLineMaps{ColorMap::kSequential, ColorMap::kHeat, ColorMap::kDiverging};

/// As few digits as give the same number back.
std::string text_of(float value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

}  // namespace

Background parse_background(const std::string& text) {
  if (text == "dark") return Background::kDark;
  if (text == "light") return Background::kLight;
  const std::string refusal =
      "--background " + text + ": dark, light, or a colour r,g,b with parts from 0 to 1 is expected";
  const auto parts = parse_numbers(text, 3, refusal);
  if (std::ranges::any_of(parts, [](double part) { return !(part >= 0.0 && part <= 1.0); }))
    throw usage_error(refusal);
  const Rgb color(parts[0], parts[1], parts[2]);
  return {color, color};
}

std::string background_text(const Background& background) {
  if (background == Background::kDark) return "dark";
  if (background == Background::kLight) return "light";
  const Rgb& color = background.top;
  return text_of(color.r) + "," + text_of(color.g) + "," + text_of(color.b);
}

std::optional<ValueRange> range_of(const ViewOptions& options) {
  if (options.range.empty()) return std::nullopt;
  const char* const grammar = "--range takes the lowest and the highest value of the colours: lower,upper";
  const auto ends = parse_numbers(options.range, 2, grammar);
  if (!(ends[0] < ends[1])) throw usage_error(grammar);
  return ValueRange{ends[0], ends[1]};
}

LineStyle default_line_style(FieldKind kind) {
  LineStyle style;
  if (kind != FieldKind::kFibre) return style;
  constexpr double kThin = 1.6;
  style.width = kThin;
  style.halo = false;
  return style;
}

void show_quantity(const std::string& color, LineStyle& style) {
  for (int i = 0; i < kColorByCount; ++i) {
    const auto by = static_cast<ColorBy>(i);
    if (by != ColorBy::kArray && name_of(by) == color) style.color_by = by;
  }
}

void apply_colors(const ViewOptions& options, LineStyle& style) {
  show_quantity(options.color, style);
  style.range = range_of(options);
  style.logarithmic = options.log_colors;
  style.color_map.reset();
  for (const ColorMap map : kLineMaps)
    if (name_of(map) == options.color_map) style.color_map = map;
}

void apply_appearance(const Document& document, SceneView& view) {
  const ViewOptions& options = document.view;
  const LineStyle usual = default_line_style(document.input.kind);
  view.background = parse_background(options.background);
  view.show_outline = options.outline;
  view.show_axes = options.axes;
  view.show_color_bar = options.color_bar;
  view.color_bar_left = options.color_bar_side == "left";
  view.show_scale_bar = options.scale_bar;
  view.caption = options.caption;
  view.camera.projection = projection_of(document.volume);
  apply_colors(options, view.style);
  view.style.width = options.line_width.value_or(usual.width);
  view.style.opacity = options.line_opacity;
  view.style.halo = options.halos.value_or(usual.halo);
  view.style.depth_cue = options.depth_cue;
}

}  // namespace palpate
