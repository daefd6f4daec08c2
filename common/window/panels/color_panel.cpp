#include "common/window/panels/color_panel.h"

#include <array>
#include <string>

#include <imgui.h>

#include "common/window/panels/panel_parts.h"

namespace palpate {

namespace {

/// What the lines themselves have.
void list_quantities(LineStyle& style, std::string& color) {
  for (int i = 0; i < kColorByCount; ++i) {
    const auto by = static_cast<ColorBy>(i);
    const std::string name(name_of(by));
    if (by == ColorBy::kArray || !selectable(name.c_str(), color == name)) continue;
    style.color_by = by;
    style.range.reset();
    style.usual.reset();
    style.logarithmic.reset();
    color = name;
  }
}

void draw_color(PanelContext& on, std::string& color, bool quantities) {
  if (!section("COLOUR")) return;
  LineStyle& style = on.view.style;
  const bool chooses = begin_combo("by", color.c_str());
  explain(quantities ? "color" : "angle", false);
  if (chooses) {
    if (quantities) list_quantities(style, color);
    // These have to be sampled first: the colours follow when that is done.
    for (const std::string& name : on.scene.info->color_arrays)
      if (selectable(name.c_str(), name == color)) color = name;
    ImGui::EndCombo();
  }
  const bool mapped = style.color_by != ColorBy::kDirection && style.color_by != ColorBy::kTermination &&
                      style.color_by != ColorBy::kUniform;
  if (!mapped) return;
  const ColorMap map = color_map_of(style);
  ColorMap chosen = map;
  if (edit_setting("color-map", chosen)) {
    style.color_map = chosen;
    style.usual.reset();  // of diverging maps it lies about zero
  }
  bool automatic = !style.range.has_value();
  if (checkbox("automatic range", &automatic)) {
    style.range =
        automatic ? std::nullopt : std::optional(on.state.picture.automatic_range.value_or(ValueRange{}));
    style.usual.reset();
  }
  hint(
      "of the usual values; other time steps keep it, with tips at the bar where values lie beyond: switch it "
      "off and on for that of this step");
  if (style.range) {
    ValueRange range = *style.range;
    std::array<double, 2> ends{range.lower, range.upper};
    if (input_numbers("range", ends.data(), 2, "%.4g") && ends[0] < ends[1]) {
      style.range = ValueRange{ends[0], ends[1]};
    }
    explain("range");
  }
  if (style.color_by != ColorBy::kSeed) {
    bool logarithmic = is_logarithmic(style);
    if (edit_setting("log-colors", logarithmic)) {
      style.logarithmic = logarithmic;
      style.usual.reset();
    }
  }
}

}  // namespace

void draw_line_colors(PanelContext& on) { draw_color(on, on.state.document.view.color, true); }

void draw_layer_colors(PanelContext& on) { draw_color(on, on.state.document.heart.angle, false); }

}  // namespace palpate
