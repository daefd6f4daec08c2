#include "common/window/panels/series_choice.h"

#include <algorithm>
#include <cfloat>
#include <utility>

#include <imgui.h>

#include "common/window/panels/panel_parts.h"

namespace palpate {
namespace {

constexpr const char* kSeriesId = "###series";

}  // namespace

void SeriesChoice::ask(InputFiles folder, std::vector<std::string> series) {
  folder_ = std::move(folder);
  series_ = std::move(series);
}

std::optional<InputFiles> SeriesChoice::draw() {
  if (!asking()) return std::nullopt;
  if (!ImGui::IsPopupOpen(kSeriesId)) ImGui::OpenPopup(kSeriesId);
  center_next_window();
  constexpr float kWidth = 34.0F, kRow = 1.9F, kHighest = 22.0F;  // heights of the text
  const float em = ImGui::GetFontSize();
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                      ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize;
  std::optional<InputFiles> chosen;
  bool leaves = ImGui::IsKeyPressed(ImGuiKey_Escape);
  if (ImGui::BeginPopupModal(kSeriesId, nullptr, kFlags)) {
    std::string name;
    for (const auto& file : folder_.files) name += (name.empty() ? "" : " ") + file.filename().string();
    ImGui::Text("%s holds %zu series: choose one", name.c_str(), series_.size());
    ImGui::Separator();
    const float rows = kRow * em * static_cast<float>(series_.size());
    ImGui::BeginChild("##rows", {kWidth * em, std::min(rows, kHighest * em)});
    for (std::size_t i = 0; i < series_.size(); ++i) {
      const std::string number = std::to_string(i + 1);
      if (!button((number + "  " + series_[i]).c_str(), {-FLT_MIN, 0.0F})) continue;
      chosen = folder_;
      chosen->series = number;
    }
    ImGui::EndChild();
    leaves |= button("Cancel", {8.0F * em, 0.0F});
    if (chosen || leaves) {
      series_.clear();
      ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
  }
  return chosen;
}

}  // namespace palpate
