#include "common/window/panels/series_panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include <imgui.h>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/render/ticks.h"
#include "common/window/panels/picture_panels.h"

namespace palpate {
namespace {

/// Of the finite values, with a little room; nothing where there is none.
std::optional<ValueRange> range_of(const std::vector<double>& values) {
  ValueRange range{HUGE_VAL, -HUGE_VAL};
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    range = {std::min(range.lower, v), std::max(range.upper, v)};
  }
  if (range.lower > range.upper) return std::nullopt;
  constexpr double kRoom = 0.05;
  const double extent = range.upper - range.lower;
  const double room = extent > 0.0 ? kRoom * extent : std::max(kRoom * std::abs(range.upper), kRoom);
  return ValueRange{range.lower - room, range.upper + room};
}

/// From times and values to pixels.
struct PlotAxes {
  ValueRange times, values;
  ImVec2 lower{0.0F, 0.0F}, upper{0.0F, 0.0F};  // corners: left and top, right and bottom

  [[nodiscard]] float x(double time) const {
    const double part = (time - times.lower) / (times.upper - times.lower);
    return lower.x + static_cast<float>(part) * (upper.x - lower.x);
  }
  [[nodiscard]] float y(double value) const {
    const double part = (value - values.lower) / (values.upper - values.lower);
    return upper.y - static_cast<float>(part) * (upper.y - lower.y);
  }
};

void draw_ticks(const PlotAxes& axes) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImU32 words = ImGui::GetColorU32(ImGuiCol_TextDisabled), grid = ImGui::GetColorU32(ImGuiCol_Border);
  const float em = ImGui::GetFontSize();
  constexpr int kAcross = 8, kUp = 4;
  for (const Tick& tick : ticks(axes.times, false, kAcross)) {
    const float x = axes.x(tick.value);
    draw.AddLine({x, axes.lower.y}, {x, axes.upper.y}, grid);
    const float width = ImGui::CalcTextSize(tick.text.c_str()).x;
    draw.AddText({x - 0.5F * width, axes.upper.y + 0.15F * em}, words, tick.text.c_str());
  }
  for (const Tick& tick : ticks(axes.values, false, kUp)) {
    const float y = axes.y(tick.value);
    draw.AddLine({axes.lower.x, y}, {axes.upper.x, y}, grid);
    const float width = ImGui::CalcTextSize(tick.text.c_str()).x;
    draw.AddText({axes.lower.x - width - 0.4F * em, y - 0.5F * em}, words, tick.text.c_str());
  }
}

/// Where there are gaps, values that are not there break the line, ones that are still to come do not.
void draw_curve(const PlotAxes& axes, const SeriesCurve& curve) {
  const bool all = curve.read == curve.times.size();
  std::vector<ImVec2> stretch;
  const auto end = [&] {
    constexpr float kWidth = 2.0F;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImU32 color = ImGui::GetColorU32(ImGuiCol_PlotLines);
    if (stretch.size() == 1) draw.AddCircleFilled(stretch.front(), kWidth, color);
    draw.AddPolyline(stretch.data(), static_cast<int>(stretch.size()), color, ImDrawFlags_None, kWidth);
    stretch.clear();
  };
  for (std::size_t i = 0; i < curve.times.size(); ++i) {
    if (std::isfinite(curve.values[i])) {
      stretch.push_back({axes.x(curve.times[i]), axes.y(curve.values[i])});
    } else if (all) {
      end();
    }
  }
  end();
}

/// The last value at or before a time; NaN where there is none yet.
double value_at(const SeriesCurve& curve, double time) {
  const auto after = std::upper_bound(curve.times.begin(), curve.times.end(), time);
  return after == curve.times.begin() ? std::nan("") : curve.values[as_size(after - curve.times.begin()) - 1];
}

std::string title_of(const SeriesPlot& plot, const UnitNames& units) {
  const SeriesCurve& curve = plot.curve;
  const std::string unit = units.time.empty() ? "" : " " + units.time;
  std::string text = curve.name;
  if (!curve.problem.empty()) return text + ": " + curve.problem;
  if (!curve.place) return text + (plot.reading ? ": reading" : ": grab the probe (G) to plot it there");
  const double value = value_at(curve, plot.now);
  const auto known = [](double v) { return std::isfinite(v); };
  if (curve.read > 0 && std::ranges::none_of(curve.values, known)) text += ": none";
  if (std::isfinite(value)) text += " " + short_number(value) + " at t = " + short_number(plot.now) + unit;
  std::array<char, 96> place{};
  std::snprintf(place.data(), place.size(), ", at %.5g  %.5g  %.5g", curve.place->x, curve.place->y,
                curve.place->z);
  text += place.data();
  if (plot.reading)
    text += ", " + std::to_string(curve.read) + " of " + std::to_string(curve.times.size()) + " steps";
  return text;
}

}  // namespace

PictureArea series_plot_area(const PictureArea& picture, float text_height) {
  // The axes are left of it, colour bars above.
  const double em = text_height, left = picture.left + 9.0 * em;
  const double width = std::clamp(picture.width - 10.0 * em, 1.0, 44.0 * em);
  const double height = std::min(11.0 * em, 0.4 * picture.height);
  return {left, picture.top + picture.height - height - em, width, height};
}

std::optional<double> draw_series_plot(const SeriesPlot& plot, const PictureArea& area,
                                       const UnitNames& units) {
  ImGui::SetNextWindowPos({static_cast<float>(area.left), static_cast<float>(area.top)});
  ImGui::SetNextWindowSize({static_cast<float>(area.width), static_cast<float>(area.height)});
  ImGui::SetNextWindowBgAlpha(0.8F);
  ImGui::Begin("series", nullptr, kFixedPanel | ImGuiWindowFlags_NoScrollbar);
  ImGui::TextUnformatted(title_of(plot, units).c_str());
  std::optional<double> picked;
  const std::optional<ValueRange> values = range_of(plot.curve.values);
  if (values && plot.curve.times.back() > plot.curve.times.front()) {
    const float em = ImGui::GetFontSize();
    const ImVec2 corner = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    const PlotAxes axes{.times = {plot.curve.times.front(), plot.curve.times.back()},
                        .values = *values,
                        .lower = {corner.x + 4.0F * em, corner.y + 0.3F * em},
                        .upper = {corner.x + room.x - em, corner.y + room.y - 1.3F * em}};
    draw_ticks(axes);
    draw_curve(axes, plot.curve);
    const float x = axes.x(std::clamp(plot.now, axes.times.lower, axes.times.upper));
    ImGui::GetWindowDrawList()->AddLine({x, axes.lower.y}, {x, axes.upper.y},
                                        ImGui::GetColorU32(ImGuiCol_PlotLinesHovered), 2.0F);
    ImGui::SetCursorScreenPos(axes.lower);
    ImGui::InvisibleButton(
        "times", {std::max(1.0F, axes.upper.x - axes.lower.x), std::max(1.0F, axes.upper.y - axes.lower.y)});
    if (ImGui::IsItemActive()) {
      const double part = (ImGui::GetIO().MousePos.x - axes.lower.x) / (axes.upper.x - axes.lower.x);
      picked = axes.times.lower + std::clamp(part, 0.0, 1.0) * (axes.times.upper - axes.times.lower);
    }
  }
  ImGui::End();
  return picked;
}

}  // namespace palpate
