#include "apps/dtmri/bundle_plot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <imgui.h>

#include "common/render/line_style.h"
#include "common/render/ticks.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {
namespace {

ValueRange range_of(std::span<const BundleCurve> curves) {
  ValueRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const BundleCurve& curve : curves) {
    for (const BundleNode& node : curve.profile->nodes) {
      if (!std::isfinite(node.lower) || !std::isfinite(node.upper)) continue;
      range = {std::min({range.lower, node.lower, node.mean}),
               std::max({range.upper, node.upper, node.mean})};
    }
  }
  return range;
}

/// From nodes and values to pixels.
struct PlotFrame {
  ValueRange values;
  ImVec2 corner{0.0F, 0.0F}, size{1.0F, 1.0F};

  [[nodiscard]] ImVec2 at(double part, double value) const {
    const double up = (value - values.lower) / std::max(values.upper - values.lower, 1e-300);
    return {corner.x + static_cast<float>(part) * size.x,
            corner.y + size.y - static_cast<float>(up) * size.y};
  }
};

void draw_curve(const PlotFrame& frame, const BundleCurve& curve) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const auto color = [&](float alpha) {
    return ImGui::ColorConvertFloat4ToU32({curve.color.x, curve.color.y, curve.color.z, alpha});
  };
  constexpr float kBand = 0.22F, kWidth = 2.0F;
  const std::vector<BundleNode>& nodes = curve.profile->nodes;
  for (std::size_t n = 0; n + 1 < nodes.size(); ++n) {
    const BundleNode &a = nodes[n], &b = nodes[n + 1];
    if (!std::isfinite(a.mean) || !std::isfinite(b.mean)) continue;
    const double count = static_cast<double>(nodes.size() - 1);
    const double from = static_cast<double>(n) / count, to = static_cast<double>(n + 1) / count;
    draw.AddQuadFilled(frame.at(from, a.lower), frame.at(from, a.upper), frame.at(to, b.upper),
                       frame.at(to, b.lower), color(kBand));
    draw.AddLine(frame.at(from, a.mean), frame.at(to, b.mean), color(1.0F), kWidth);
  }
}

}  // namespace

void draw_bundle_plot(const std::string& name, std::span<const BundleCurve> curves) {
  const ValueRange range = range_of(curves);
  if (!(range.lower <= range.upper)) {
    ImGui::TextDisabled("%s has no value along these bundles", name.c_str());
    return;
  }
  constexpr float kHeight = 8.0F, kLeft = 3.6F;  // of the letters
  const float em = ImGui::GetFontSize();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 room{std::max(8.0F * em, ImGui::GetContentRegionAvail().x), kHeight * em};
  const PlotFrame frame{.values = range,
                        .corner = {corner.x + kLeft * em, corner.y + 0.5F * em},
                        .size = {room.x - (kLeft + 0.5F) * em, room.y - 2.2F * em}};
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImU32 words = ImGui::GetColorU32(ImGuiCol_TextDisabled), grid = ImGui::GetColorU32(ImGuiCol_Border);
  constexpr int kMostTicks = 5;
  for (const Tick& tick : ticks(range, false, kMostTicks)) {
    const ImVec2 left = frame.at(0.0, tick.value), right = frame.at(1.0, tick.value);
    draw.AddLine(left, right, grid);
    const float width = ImGui::CalcTextSize(tick.text.c_str()).x;
    draw.AddText({left.x - width - 0.3F * em, left.y - 0.5F * em}, words, tick.text.c_str());
  }
  for (const BundleCurve& curve : curves) draw_curve(frame, curve);
  const ImVec2 below = frame.at(0.0, range.lower);
  draw.AddText({below.x, below.y + 0.3F * em}, words, (name + " from left, back or feet").c_str());
  ImGui::Dummy(room);
  note_control("bundle plot");
}

}  // namespace palpate
