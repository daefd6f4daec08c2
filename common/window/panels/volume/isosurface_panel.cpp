#include "common/window/panels/volume/isosurface_panel.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <string>
#include <vector>

#include <imgui.h>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/render/surface/surface_view.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {
namespace {

/// Bars over the range of the data, as roots, so that rare values show; a line at each isovalue. How far the
/// isosurface is stands on it, so that no control below moves.
void draw_histogram(const char* label, const ValueHistogram* histogram, const ScalarField& field,
                    const Isovalues& isovalues, std::optional<double> fraction) {
  constexpr std::size_t kBars = 64;
  std::vector<float> bars(kBars, 0.0F);
  const std::size_t bins = histogram != nullptr ? histogram->counts.size() : 0;
  for (std::size_t i = 0; i < bins; ++i) {
    bars[i * kBars / bins] += static_cast<float>(histogram->counts[i]);
  }
  std::string words;
  if (fraction) words = "isosurface " + std::to_string(std::lround(100.0 * *fraction)) + " %";
  for (float& bar : bars) bar = std::sqrt(bar);
  const ImVec2 size{ImGui::CalcItemWidth(), 2.2F * ImGui::GetFontSize()};
  ImGui::PlotHistogram(label, bars.data(), static_cast<int>(kBars), 0, fraction ? words.c_str() : nullptr,
                       0.0F, FLT_MAX, size);
  const ImVec2 corner = ImGui::GetItemRectMin();
  const double range = field.highest() - field.lowest();
  for (int i = 0; i < isovalues.count && range > 0.0; ++i) {
    const double part = (isovalues.value[as_size(i)] - field.lowest()) / range;
    const float x = corner.x + size.x * static_cast<float>(std::clamp(part, 0.0, 1.0));
    ImGui::GetWindowDrawList()->AddLine({x, corner.y}, {x, corner.y + size.y},
                                        ImGui::GetColorU32(ImGuiCol_Text), 2.0F);
  }
}

void remove(Isovalues& isovalues, int index) {
  for (int i = index; i + 1 < isovalues.count; ++i) {
    isovalues.value[as_size(i)] = isovalues.value[as_size(i) + 1];
  }
  isovalues.value[as_size(--isovalues.count)] = 0.0;
}

/// A slider each, and the buttons that add and remove one.
/// @param what "isosurface", or the "layer" of a heart.
Isovalues edit_values(const HapticLevels& levels, const std::string& what) {
  Isovalues isovalues = levels.isovalues;
  const double lowest = levels.field->lowest(), highest = levels.field->highest();
  int removed = -1;
  for (int i = 0; i < isovalues.count; ++i) {
    double& value = isovalues.value[as_size(i)];
    ImGui::PushID(i);
    slider_scalar("##isovalue", ImGuiDataType_Double, &value, &lowest, &highest, "%.5g");
    explain("isovalue");
    ImGui::SameLine();
    if (isovalues.count > 1) {
      if (small_button("x")) removed = i;
      hint("remove this %s", what.c_str());
    } else {
      ImGui::TextUnformatted("isovalue");
    }
    ImGui::PopID();
    if (!std::isfinite(value)) value = levels.isovalues.value[as_size(i)];
  }
  if (removed >= 0) remove(isovalues, removed);
  if (isovalues.count < Isovalues::kMax && small_button(("+ " + what).c_str())) {
    isovalues = with_another(isovalues, lowest, highest);
  }
  return isovalues;
}

}  // namespace

Isovalues with_another(const Isovalues& isovalues, double lowest, double highest) {
  std::vector<double> places{lowest, highest};
  for (int i = 0; i < isovalues.count; ++i) {
    places.push_back(std::clamp(isovalues.value[as_size(i)], lowest, highest));
  }
  std::sort(places.begin(), places.end());
  double middle = lowest, widest = -1.0;
  for (std::size_t i = 1; i < places.size(); ++i) {
    if (places[i] - places[i - 1] <= widest) continue;
    widest = places[i] - places[i - 1];
    middle = places[i - 1] + 0.5 * widest;
  }
  Isovalues result = isovalues;
  result.value[as_size(result.count++)] = middle;
  return result;
}

void edit_isosurfaces(IsosurfaceSettings& settings, const HapticLevels& levels,
                      const HapticSurfaces::Made& made, std::optional<double> fraction,
                      const std::string& mode, bool flow) {
  if (!levels.field) return;
  // The layers of a heart hold as such.
  const bool chosen = mode == kIsosurfaceMode;
  draw_histogram(chosen ? "histogram" : "depths", made.histogram.get(), *levels.field, levels.isovalues,
                 fraction);
  const Isovalues edited = edit_values(levels, chosen ? "isosurface" : "layer");
  if (!(edited == levels.isovalues)) settings.isovalues = edited;
  if (chosen) edit_setting("surface", settings.hold);
  edit_setting("depth", settings.depth, kMillimetres);
  if (!chosen || settings.hold == IsosurfaceHold::kLayer)
    edit_setting("snap", settings.snap_distance, kMillimetres);
  settings.snap_distance = std::min(settings.snap_distance, settings.depth);
  if (flow) edit_setting("along-streamline", settings.along_streamline);
  if (!made.problem.empty()) ImGui::TextWrapped("%s", made.problem.c_str());
}

}  // namespace palpate
