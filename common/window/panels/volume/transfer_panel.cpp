#include "common/window/panels/volume/transfer_panel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <imgui.h>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/transfer/color_transfer.h"
#include "common/field/transfer/region_transfer.h"
#include "common/window/panels/panel_parts.h"
#include "common/window/panels/volume/region_transfer_editor.h"

namespace palpate {
namespace {

constexpr float kHeight = 110.0F;     // [pixels]
constexpr float kPointRadius = 4.5F;  // [pixels]
constexpr double kPointReach = 0.07;  // of the side: as near as that, a click is on a point
constexpr int kNone = -1;

/// Between places and pixels.
class Canvas {
 public:
  Canvas(const ImVec2& corner, const ImVec2& size, const ValueSpan& span)
      : corner_(corner), size_(size), span_(span) {}

  [[nodiscard]] ImVec2 pixel(double value, double opacity) const {
    const double u = (value - span_.low) / (span_.high - span_.low);
    return {corner_.x + size_.x * static_cast<float>(u),
            corner_.y + size_.y * static_cast<float>(1.0 - opacity)};
  }
  [[nodiscard]] double value(const ImVec2& pixel) const {
    return std::lerp(span_.low, span_.high, static_cast<double>((pixel.x - corner_.x) / size_.x));
  }
  [[nodiscard]] double opacity(const ImVec2& pixel) const {
    return static_cast<double>(1.0F - (pixel.y - corner_.y) / size_.y);
  }

 private:
  ImVec2 corner_, size_;
  ValueSpan span_;
};

ImU32 ink_of(const Vec3f& color, float alpha = 1.0F) {
  return ImGui::ColorConvertFloat4ToU32({color.r, color.g, color.b, alpha});
}

/// Bars as roots, so that rare values show.
void draw_histogram(const Canvas& canvas, const ValueHistogram& histogram) {
  if (histogram.counts.empty() || !(histogram.lower < histogram.upper)) return;
  constexpr std::size_t kBars = 96;
  std::vector<double> bars(kBars, 0.0);
  const std::size_t bins = histogram.counts.size();
  for (std::size_t i = 0; i < bins; ++i) bars[i * kBars / bins] += static_cast<double>(histogram.counts[i]);
  double most = 0.0;
  for (double& bar : bars) most = std::max(most, bar = std::sqrt(bar));
  if (!(most > 0.0)) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 ink = ImGui::GetColorU32(ImGuiCol_PlotHistogram, 0.35F);
  const double width = (histogram.upper - histogram.lower) / static_cast<double>(kBars);
  for (std::size_t i = 0; i < kBars; ++i) {
    const double from = histogram.lower + width * static_cast<double>(i);
    list.AddRectFilled(canvas.pixel(from, bars[i] / most), canvas.pixel(from + width, 0.0), ink);
  }
}

void draw(const Canvas& canvas, const ValueSpan& span, const ValueHistogram* histogram,
          const ColorTransfer& transfer, int marked) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 upper_left = canvas.pixel(span.low, 1.0), lower_right = canvas.pixel(span.high, 0.0);
  list.AddRectFilled(upper_left, lower_right, ImGui::GetColorU32(ImGuiCol_FrameBg));
  list.PushClipRect(upper_left, lower_right, true);
  if (histogram != nullptr) draw_histogram(canvas, *histogram);
  list.PopClipRect();
  // The colours along the foot.
  constexpr std::size_t kStrips = 96;
  constexpr float kFoot = 5.0F;
  const std::vector<ColorSample> samples = transfer.table(span.low, span.high, kStrips);
  for (std::size_t i = 0; i + 1 < kStrips; ++i) {
    const double a = std::lerp(span.low, span.high, static_cast<double>(i) / (kStrips - 1));
    const double b = std::lerp(span.low, span.high, static_cast<double>(i + 1) / (kStrips - 1));
    const ImVec2 p = canvas.pixel(a, 0.0), q = canvas.pixel(b, 0.0);
    list.AddRectFilled({p.x, p.y - kFoot}, q, ink_of(samples[i].color));
  }
  const auto& points = transfer.points();
  if (points.empty()) return;
  std::vector<ImVec2> line{canvas.pixel(span.low, points.front().opacity)};
  for (const ColorPoint& point : points) line.push_back(canvas.pixel(point.value, point.opacity));
  line.push_back(canvas.pixel(span.high, points.back().opacity));
  list.AddPolyline(line.data(), static_cast<int>(line.size()), ImGui::GetColorU32(ImGuiCol_PlotLines), 0,
                   1.5F);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ImVec2 at = canvas.pixel(points[i].value, points[i].opacity);
    const bool is_marked = static_cast<int>(i) == marked;
    list.AddCircleFilled(at, kPointRadius, ink_of(points[i].color));
    list.AddCircle(at, is_marked ? kPointRadius + 2.0F : kPointRadius, ImGui::GetColorU32(ImGuiCol_Text), 0,
                   is_marked ? 2.0F : 1.0F);
  }
}

/// Where a value lies in the other domain, that of the values.
void draw_mark(const Canvas& canvas, const ValueSpan& span, double value) {
  if (!(value >= span.low && value <= span.high)) return;
  const ImU32 ink = ImGui::GetColorU32(ImGuiCol_PlotLinesHovered);
  const ImVec2 top = canvas.pixel(value, 1.0), foot = canvas.pixel(value, 0.0);
  constexpr float kHead = 4.0F;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddLine(top, foot, ink, 1.5F);
  list.AddTriangleFilled({top.x - kHead, top.y}, {top.x + kHead, top.y}, {top.x, top.y + 1.5F * kHead}, ink);
}

/// What the mouse does to the points under it. @return whether the function changed.
bool edit(const Canvas& canvas, const ValueSpan& span, ColorTransfer& transfer, int& dragged, int& chosen) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const double value = canvas.value(mouse), opacity = canvas.opacity(mouse);
  const auto near = point_near(transfer, value, opacity, kPointReach, span);
  if (ImGui::IsItemActivated()) {
    dragged = near ? static_cast<int>(*near) : kNone;
    if (near) chosen = dragged;
  }
  if (!ImGui::IsItemActive()) dragged = kNone;
  if (ImGui::IsItemHovered()) {
    if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && !near) {
      dragged = kNone;
      transfer = with_point(transfer, value, opacity, span);
      const auto added = point_near(transfer, value, opacity, kPointReach, span);
      chosen = added ? static_cast<int>(*added) : kNone;
      return true;
    }
    if (near && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
      dragged = chosen = kNone;
      const std::size_t before = transfer.points().size();
      transfer = without_point(transfer, *near);
      return transfer.points().size() != before;
    }
  }
  const bool drags = dragged >= 0 && dragged < static_cast<int>(transfer.points().size()) &&
                     ImGui::IsMouseDragging(ImGuiMouseButton_Left, 1.0F);
  if (!drags) return false;
  ColorTransfer moved = with_point_at(transfer, as_size(dragged), value, opacity, span);
  if (moved == transfer) return false;
  transfer = std::move(moved);
  return true;
}

bool edit_color(ColorTransfer& transfer, int chosen) {
  if (chosen < 0 || chosen >= static_cast<int>(transfer.points().size())) return false;
  const auto point = as_size(chosen);
  Vec3f color = transfer.points()[point].color;
  const std::string name = short_number(transfer.points()[point].value);
  if (!color_edit(name.c_str(), &color.x, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_NoInputs))
    return false;
  transfer = with_color(transfer, point, glm::clamp(color, 0.0F, 1.0F));
  return true;
}

constexpr const char* kOwnWords = "own points or regions";
constexpr const char* kBoundariesName = "boundaries";

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (int i = 0; i < kColorPresetCount; ++i) names.emplace_back(name_of(static_cast<ColorPreset>(i)));
  names.emplace_back(kBoundariesName);
  return names;
}

/// The editor of the kind that `transfer` is. @return whether it changed.
bool edit_either(EditedTransfer& transfer, const std::shared_ptr<const VolumeImage>& image,
                 CachedHistogram& histograms, std::optional<double> isovalue) {
  if (transfer.regions)
    return draw_region_editor("regions", histograms.places_of(image), *transfer.regions, isovalue);
  return draw_transfer_editor("points", {image->lowest, image->highest}, histograms.of(image),
                              transfer.colors, isovalue);
}

}  // namespace

const ValueHistogram* CachedHistogram::of(const std::shared_ptr<const VolumeImage>& image) {
  if (image->lowest > image->highest) return nullptr;
  if (image_ == image) return &histogram_;
  constexpr std::size_t kMostVoxels = 2'000'000, kBins = 512;
  const std::size_t stride = (image->point_count() + kMostVoxels - 1) / kMostVoxels;
  histogram_ = count_values(
      image->point_count() / stride, [&](std::size_t i) { return image->value(i * stride); }, image->lowest,
      image->highest, kBins, 0);
  image_ = image;
  return &histogram_;
}

const PlaceHistogram& CachedHistogram::places_of(const std::shared_ptr<const VolumeImage>& image) {
  constexpr std::size_t kMostVoxels = 2'000'000, kColumns = 96, kRows = 48;
  if (places_image_ != image) places_ = count_places(*image, kColumns, kRows, kMostVoxels);
  places_image_ = image;
  return places_;
}

bool choose_transfer(const char* label, const char* setting_name, const char* automatic, std::string& words,
                     EditedTransfer& transfer, const std::shared_ptr<const VolumeImage>& image,
                     CachedHistogram& histograms, std::string& file, std::optional<double> isovalue) {
  const bool own = words.starts_with("points:") || words.starts_with("regions:");
  const std::string now = words.empty() ? automatic : own ? kOwnWords : words;
  ImGui::PushID(label);
  if (begin_combo(label, now.c_str())) {
    if (selectable(automatic, words.empty())) words.clear();
    for (const std::string& name : preset_names()) {
      if (selectable(name.c_str(), words == name)) words = name;
    }
    ImGui::EndCombo();
  }
  explain(setting_name);
  if (edit_either(transfer, image, histograms, isovalue))
    words = transfer.regions ? region_text(*transfer.regions) : transfer_text(transfer.colors);
  input_text("##file", &file);
  hint("the file that load and save mean");
  ImGui::SameLine();
  if (small_button("load") && !file.empty()) words = file;
  hint("a table value,red,green,blue,opacity, or regions of value and gradient");
  ImGui::SameLine();
  const bool save = small_button("save");
  hint("as such a table, to be loaded again or given on the command line");
  ImGui::PopID();
  return save && (transfer.regions || !transfer.colors.points().empty());
}

bool choose_own_transfer(const char* label, EditedTransfer& transfer,
                         const std::shared_ptr<const VolumeImage>& image, CachedHistogram& histograms) {
  const EditedTransfer before = transfer;
  ImGui::PushID(label);
  if (begin_combo(label, kOwnWords)) {
    const bool values = image->lowest <= image->highest;
    for (int i = 0; values && i < kColorPresetCount; ++i) {
      const auto preset = static_cast<ColorPreset>(i);
      if (selectable(std::string(name_of(preset)).c_str()))
        transfer = {make_color_transfer(preset, image->lowest, image->highest), {}};
    }
    if (values && selectable(kBoundariesName))
      transfer = {{}, spread(boundary_regions(), histograms.places_of(image).range)};
    ImGui::EndCombo();
  }
  hint("begins with one of these");
  (void)edit_either(transfer, image, histograms, std::nullopt);
  ImGui::PopID();
  return !(transfer == before);
}

bool draw_transfer_editor(const char* id, const ValueSpan& values, const ValueHistogram* histogram,
                          ColorTransfer& transfer, std::optional<double> isovalue) {
  if (!(values.low < values.high)) return false;
  ImGui::PushID(id);
  int& dragged = *ImGui::GetStateStorage()->GetIntRef(ImGui::GetID("dragged"), kNone);
  int& chosen = *ImGui::GetStateStorage()->GetIntRef(ImGui::GetID("chosen"), kNone);
  const ValueSpan span = grown(values, transfer);
  const ImVec2 size{std::max(ImGui::GetContentRegionAvail().x, 1.0F), kHeight};
  const Canvas canvas(ImGui::GetCursorScreenPos(), size, span);
  ImGui::InvisibleButton("points", size,
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
  note_control(id);
  bool changed = edit(canvas, span, transfer, dragged, chosen);
  const bool hovered = ImGui::IsItemHovered();
  draw(canvas, span, histogram, transfer, chosen);
  if (isovalue) draw_mark(canvas, span, *isovalue);
  if (hovered) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    ImGui::SetTooltip("%s: opacity %.2f\ndrag a point; a double click adds one, a right click takes one out",
                      short_number(canvas.value(mouse)).c_str(), std::clamp(canvas.opacity(mouse), 0.0, 1.0));
  }
  ImGui::TextDisabled("%s to %s", short_number(span.low).c_str(), short_number(span.high).c_str());
  if (chosen >= 0) ImGui::SameLine(0.5F * size.x);
  changed = edit_color(transfer, chosen) || changed;
  ImGui::PopID();
  return changed;
}

}  // namespace palpate
