#include "common/window/panels/volume/region_transfer_editor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include <imgui.h>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {
namespace {

constexpr float kSquareHeight = 150.0F;  // [pixels]
constexpr float kCornerRadius = 4.0F;    // [pixels]
constexpr double kCornerReach = 0.06;    // of the side: as near as that, a click is on a corner
constexpr int kNoRegion = -1;

/// Between places and pixels.
class PlaceCanvas {
 public:
  PlaceCanvas(const ImVec2& corner, const ImVec2& size, const PlaceRange& range)
      : corner_(corner), size_(size), range_(range) {}

  [[nodiscard]] ImVec2 pixel(const Vec2& place) const {
    const Vec2 u = (place - range_.lower) / (range_.upper - range_.lower);
    return {corner_.x + size_.x * static_cast<float>(u.x),
            corner_.y + size_.y * static_cast<float>(1.0 - u.y)};
  }
  [[nodiscard]] Vec2 place(const ImVec2& pixel) const {
    const Vec2 u((pixel.x - corner_.x) / size_.x, 1.0F - (pixel.y - corner_.y) / size_.y);
    return range_.lower + u * (range_.upper - range_.lower);
  }

 private:
  ImVec2 corner_, size_;
  PlaceRange range_;
};

void draw_places(const PlaceCanvas& canvas, const PlaceHistogram& histogram) {
  std::uint32_t most = 0;
  for (const std::uint32_t count : histogram.counts) most = std::max(most, count);
  if (most == 0) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const Vec2 width =
      (histogram.range.upper - histogram.range.lower) / Vec2(histogram.columns, histogram.rows);
  const double scale = 1.0 / std::log1p(static_cast<double>(most));
  for (std::size_t row = 0; row < histogram.rows; ++row) {
    for (std::size_t column = 0; column < histogram.columns; ++column) {
      const std::uint32_t count = histogram.counts[column + histogram.columns * row];
      if (count == 0) continue;
      const Vec2 lower = histogram.range.lower + Vec2(column, row) * width;
      const auto shade = static_cast<float>(0.1 + 0.7 * scale * std::log1p(static_cast<double>(count)));
      const ImVec2 a = canvas.pixel(lower), b = canvas.pixel(lower + width);
      list.AddRectFilled({a.x, b.y}, {b.x, a.y}, ImGui::GetColorU32(ImGuiCol_PlotHistogram, shade));
    }
  }
}

std::vector<ImVec2> border_of(const PlaceCanvas& canvas, const TransferRegion& region) {
  if (region.shape == TransferRegion::Shape::kTriangle)
    return {canvas.pixel(region.corners[0]), canvas.pixel(region.corners[1]),
            canvas.pixel(region.corners[2])};
  const ImVec2 a = canvas.pixel(region.corners[0]), b = canvas.pixel(region.corners[1]);
  if (region.shape == TransferRegion::Shape::kBox) return {a, {b.x, a.y}, b, {a.x, b.y}};
  constexpr int kPieces = 48;
  std::vector<ImVec2> border;
  for (int i = 0; i < kPieces; ++i) {
    const float angle = 2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / kPieces;
    border.emplace_back(0.5F * (a.x + b.x) + 0.5F * (b.x - a.x) * std::cos(angle),
                        0.5F * (a.y + b.y) + 0.5F * (b.y - a.y) * std::sin(angle));
  }
  return border;
}

void draw_region(const PlaceCanvas& canvas, const TransferRegion& region, bool chosen) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto ink = [&](float alpha) {
    return ImGui::ColorConvertFloat4ToU32({region.color.r, region.color.g, region.color.b, alpha});
  };
  const std::vector<ImVec2> border = border_of(canvas, region);
  const int points = static_cast<int>(border.size());
  list.AddConvexPolyFilled(border.data(), points, ink(0.15F + 0.35F * static_cast<float>(region.opacity)));
  list.AddPolyline(border.data(), points, ink(1.0F), ImDrawFlags_Closed, chosen ? 2.5F : 1.2F);
  for (std::size_t i = 0; i < region.corner_count(); ++i) {
    const ImVec2 at = canvas.pixel(region.corners[i]);
    list.AddCircleFilled(at, kCornerRadius, ink(1.0F));
    list.AddCircle(at, kCornerRadius, ImGui::GetColorU32(ImGuiCol_Text), 0, chosen ? 2.0F : 1.0F);
  }
}

/// What is being dragged, kept from frame to frame.
struct Drag {
  int region = kNoRegion, corner = kNoRegion;  ///< without a corner all of the region
};

/// What the mouse does to the regions under it. @return whether the function changed.
bool edit_regions(const PlaceCanvas& canvas, const PlaceRange& range, RegionTransfer& transfer, Drag& drag,
                  int& chosen) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const Vec2 place = canvas.place(mouse);
  const auto corner = corner_near(transfer, place, kCornerReach, range);
  const auto region = corner ? std::optional(corner->region) : region_at(transfer, place);
  if (ImGui::IsItemActivated()) {
    drag = {region ? static_cast<int>(*region) : kNoRegion,
            corner ? static_cast<int>(corner->corner) : kNoRegion};
    if (region) chosen = drag.region;
  }
  if (!ImGui::IsItemActive()) drag = {};
  if (ImGui::IsItemHovered()) {
    if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && !region) {
      drag = {};
      transfer = with_region(transfer, place, range);
      chosen = static_cast<int>(transfer.regions().size()) - 1;
      return true;
    }
    if (region && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
      drag = {};
      chosen = kNoRegion;
      transfer = without_region(transfer, *region);
      return true;
    }
  }
  const bool drags = drag.region >= 0 && drag.region < static_cast<int>(transfer.regions().size()) &&
                     ImGui::IsMouseDragging(ImGuiMouseButton_Left, 1.0F);
  if (!drags) return false;
  const auto dragged = as_size(drag.region);
  const ImVec2 moved = ImGui::GetIO().MouseDelta;
  RegionTransfer now = drag.corner >= 0
                           ? with_corner_at(transfer, {dragged, as_size(drag.corner)}, place)
                           : with_region_moved(transfer, dragged,
                                               place - canvas.place({mouse.x - moved.x, mouse.y - moved.y}));
  if (now == transfer) return false;
  transfer = std::move(now);
  return true;
}

bool edit_appearance(RegionTransfer& transfer, int chosen) {
  if (chosen < 0 || chosen >= static_cast<int>(transfer.regions().size())) return false;
  const auto index = as_size(chosen);
  TransferRegion region = transfer.regions()[index];
  constexpr std::array kShapes{TransferRegion::Shape::kBox, TransferRegion::Shape::kEllipse,
                               TransferRegion::Shape::kTriangle};
  bool changed = false;
  for (const TransferRegion::Shape shape : kShapes) {
    if (shape != kShapes.front()) ImGui::SameLine();
    if (!ImGui::RadioButton(std::string(name_of(shape)).c_str(), region.shape == shape)) continue;
    if (region.shape == shape) continue;
    transfer = with_shape(transfer, index, shape);
    region = transfer.regions()[index];
    changed = true;
  }
  bool look = color_edit("colour", &region.color.x, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_NoInputs);
  look = slider("opacity", region.opacity, 0.0, 1.0, "%.2f") || look;
  look = slider("soft border", region.soft, 0.0, 1.0, "%.2f") || look;
  if (!look) return changed;
  region.color = glm::clamp(region.color, 0.0F, 1.0F);
  transfer = with_region_as(transfer, index, region);
  return true;
}

}  // namespace

bool draw_region_editor(const char* id, const PlaceHistogram& histogram, RegionTransfer& transfer,
                        std::optional<double> isovalue) {
  ImGui::PushID(id);
  ImGuiStorage& kept = *ImGui::GetStateStorage();
  int& region = *kept.GetIntRef(ImGui::GetID("region"), kNoRegion);
  int& corner = *kept.GetIntRef(ImGui::GetID("corner"), kNoRegion);
  int& chosen = *kept.GetIntRef(ImGui::GetID("chosen"), kNoRegion);
  const PlaceRange range = grown(histogram.range, transfer);
  const ImVec2 size{std::max(ImGui::GetContentRegionAvail().x, 1.0F), kSquareHeight};
  const PlaceCanvas canvas(ImGui::GetCursorScreenPos(), size, range);
  ImGui::InvisibleButton("regions", size,
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
  note_control(id);
  Drag drag{region, corner};
  bool changed = edit_regions(canvas, range, transfer, drag, chosen);
  region = drag.region;
  corner = drag.corner;
  const bool hovered = ImGui::IsItemHovered();

  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 a = canvas.pixel(range.lower), b = canvas.pixel(range.upper);
  list.AddRectFilled({a.x, b.y}, {b.x, a.y}, ImGui::GetColorU32(ImGuiCol_FrameBg));
  list.PushClipRect({a.x, b.y}, {b.x, a.y}, true);
  draw_places(canvas, histogram);
  for (std::size_t i = 0; i < transfer.regions().size(); ++i)
    draw_region(canvas, transfer.regions()[i], static_cast<int>(i) == chosen);
  if (isovalue) {
    list.AddLine(canvas.pixel({*isovalue, range.lower.y}), canvas.pixel({*isovalue, range.upper.y}),
                 ImGui::GetColorU32(ImGuiCol_PlotLinesHovered), 1.5F);
  }
  list.PopClipRect();
  if (hovered) {
    const Vec2 place = canvas.place(ImGui::GetIO().MousePos);
    ImGui::SetTooltip(
        "value %s, gradient %s\ndrag a region or its corners; a double click adds one, a right "
        "click takes one out",
        short_number(place.x).c_str(), short_number(place.y).c_str());
  }
  ImGui::TextDisabled("value %s to %s, gradient to %s", short_number(range.lower.x).c_str(),
                      short_number(range.upper.x).c_str(), short_number(range.upper.y).c_str());
  changed = edit_appearance(transfer, chosen) || changed;
  ImGui::PopID();
  return changed;
}

}  // namespace palpate
