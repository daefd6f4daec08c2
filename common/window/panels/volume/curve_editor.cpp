#include "common/window/panels/volume/curve_editor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <imgui.h>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {
namespace {

using Knot = HapticTransferFunction::Knot;

constexpr float kHeight = 96.0F;     // [pixels]
constexpr float kKnotRadius = 4.0F;  // [pixels]
constexpr double kKnotReach = 0.07;  // of the side: as near as that, a click is on a knot
constexpr int kNoKnot = -1;

/// Between knots and pixels.
class Canvas {
 public:
  Canvas(const ImVec2& corner, const ImVec2& size, const CurveRange& range)
      : corner_(corner), size_(size), range_(range) {}

  [[nodiscard]] ImVec2 pixel(const Knot& knot) const {
    const double u = (knot.measure - range_.low_measure) / (range_.high_measure - range_.low_measure);
    const double v = (knot.value - range_.low_value) / (range_.high_value - range_.low_value);
    return {corner_.x + size_.x * static_cast<float>(u), corner_.y + size_.y * static_cast<float>(1.0 - v)};
  }
  [[nodiscard]] Knot knot(const ImVec2& pixel) const {
    const double u = (pixel.x - corner_.x) / size_.x, v = 1.0 - (pixel.y - corner_.y) / size_.y;
    return {std::lerp(range_.low_measure, range_.high_measure, u),
            std::lerp(range_.low_value, range_.high_value, v)};
  }

 private:
  ImVec2 corner_, size_;
  CurveRange range_;
};

std::string knot_text(const Knot& knot, const HapticTransferFunction& function, const CurveLabels& labels) {
  const std::string value =
      short_number(knot.value * labels.units) + (labels.unit.empty() ? "" : " ") + labels.unit;
  return function.constant() ? value : labels.measure + " " + short_number(knot.measure) + ": " + value;
}

/// What the mouse does to the curve under it. @return whether it changed.
bool edit(const Canvas& canvas, const CurveRange& range, HapticTransferFunction& function, int& dragged) {
  const Knot mouse = canvas.knot(ImGui::GetIO().MousePos);
  const auto near = knot_near(function, mouse, kKnotReach, range);
  if (ImGui::IsItemActivated()) dragged = near ? static_cast<int>(*near) : kNoKnot;
  if (!ImGui::IsItemActive()) dragged = kNoKnot;
  if (ImGui::IsItemHovered()) {
    if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && (!near || function.constant())) {
      dragged = kNoKnot;
      return add_knot(function, mouse, range);
    }
    if (near && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
      dragged = kNoKnot;
      return remove_knot(function, *near);
    }
  }
  const bool drags = dragged >= 0 && dragged < static_cast<int>(function.knots().size()) &&
                     ImGui::IsMouseDragging(ImGuiMouseButton_Left, 1.0F);
  if (!drags) return false;
  const HapticTransferFunction before = function;
  move_knot(function, as_size(dragged), mouse, range);
  return !(function == before);
}

/// Bars as roots, so that rare measures show.
void draw_bars(const Canvas& canvas, const CurveRange& range, const ValueHistogram& histogram) {
  if (histogram.counts.empty() || !(histogram.lower < histogram.upper)) return;
  constexpr std::size_t kBars = 96;
  std::array<double, kBars> bars{};
  for (std::size_t i = 0; i < histogram.counts.size(); ++i)
    bars[i * kBars / histogram.counts.size()] += static_cast<double>(histogram.counts[i]);
  const double most = std::sqrt(*std::ranges::max_element(bars));
  if (!(most > 0.0)) return;
  const ImU32 ink = ImGui::GetColorU32(ImGuiCol_PlotHistogram, 0.35F);
  const double width = (histogram.upper - histogram.lower) / static_cast<double>(kBars);
  for (std::size_t i = 0; i < kBars; ++i) {
    const double from = histogram.lower + width * static_cast<double>(i);
    const double height = std::lerp(range.low_value, range.high_value, std::sqrt(bars[i]) / most);
    ImGui::GetWindowDrawList()->AddRectFilled(canvas.pixel({from, height}),
                                              canvas.pixel({from + width, range.low_value}), ink);
  }
}

void draw(const Canvas& canvas, const CurveRange& range, const HapticTransferFunction& function, int marked,
          const ValueHistogram* histogram) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 low = canvas.pixel({range.low_measure, range.low_value});
  const ImVec2 high = canvas.pixel({range.high_measure, range.high_value});
  const ImVec2 upper_left{low.x, high.y}, lower_right{high.x, low.y};
  list.AddRectFilled(upper_left, lower_right, ImGui::GetColorU32(ImGuiCol_FrameBg));
  constexpr int kPieces = 96;
  std::array<ImVec2, kPieces + 1> points{};
  for (int i = 0; i <= kPieces; ++i) {
    const double measure = std::lerp(range.low_measure, range.high_measure, static_cast<double>(i) / kPieces);
    points[as_size(i)] = canvas.pixel({measure, function(measure)});
  }
  list.PushClipRect(upper_left, lower_right, true);
  if (histogram != nullptr && !function.constant()) draw_bars(canvas, range, *histogram);
  list.AddPolyline(points.data(), static_cast<int>(points.size()), ImGui::GetColorU32(ImGuiCol_PlotLines), 0,
                   1.5F);
  list.PopClipRect();
  if (function.constant()) return;
  for (std::size_t i = 0; i < function.knots().size(); ++i) {
    const bool is_marked = static_cast<int>(i) == marked;
    list.AddCircleFilled(canvas.pixel(function.knots()[i]), is_marked ? kKnotRadius + 1.0F : kKnotRadius,
                         ImGui::GetColorU32(is_marked ? ImGuiCol_PlotLinesHovered : ImGuiCol_CheckMark));
  }
}

}  // namespace

bool draw_curve_editor(const CurveLabels& labels, const CurveRange& range, HapticTransferFunction& function,
                       const ValueHistogram* histogram) {
  ImGui::PushID(labels.name.c_str());
  int& dragged = *ImGui::GetStateStorage()->GetIntRef(ImGui::GetID("dragged"), kNoKnot);
  const CurveRange shown = grown(range, function);
  const ImVec2 size{std::max(ImGui::GetContentRegionAvail().x, 1.0F), kHeight};
  const Canvas canvas(ImGui::GetCursorScreenPos(), size, shown);
  ImGui::InvisibleButton("curve", size, ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
  note_control(labels.name.c_str());
  bool changed = edit(canvas, shown, function, dragged);
  const auto near = knot_near(function, canvas.knot(ImGui::GetIO().MousePos), kKnotReach, shown);
  const bool hovered = ImGui::IsItemHovered();
  draw(canvas, shown, function,
       dragged >= 0      ? dragged
       : hovered && near ? static_cast<int>(*near)
                         : kNoKnot,
       histogram);
  if (hovered && near) {
    ImGui::SetTooltip("%s", knot_text(function.knots()[*near], function, labels).c_str());
  } else if (hovered) {
    ImGui::SetTooltip("drag a knot; a double click adds one, a right click takes one out");
  }
  if (function.constant()) {
    ImGui::TextDisabled("%s everywhere", knot_text(function.knots()[0], function, labels).c_str());
  } else {
    ImGui::TextDisabled("%s %s to %s", labels.measure.c_str(), short_number(shown.low_measure).c_str(),
                        short_number(shown.high_measure).c_str());
    ImGui::SameLine();
    bool smooth = function.smooth();
    if (checkbox("smooth", &smooth)) {
      set_smooth(function, smooth);
      changed = true;
    }
  }
  ImGui::PopID();
  return changed;
}

}  // namespace palpate
