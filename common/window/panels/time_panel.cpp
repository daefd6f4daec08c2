#include "common/window/panels/time_panel.h"

#include <cstddef>
#include <string>

#include <imgui.h>

#include "common/base/text.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {

void draw_time(PanelState& state, const std::vector<double>& times) {
  if (times.size() < 2) return;
  int step = static_cast<int>(state.settings.time_step);
  const int last = static_cast<int>(times.size()) - 1;
  const std::string text = "t = " + short_number(times[state.settings.time_step]);
  if (ImGui::SliderInt("time step", &step, 0, last, text.c_str(), ImGuiSliderFlags_AlwaysClamp)) {
    state.settings.time_step = static_cast<std::size_t>(step);
  }
  if (ImGui::SmallButton(state.playing ? "Stop###play" : "Play###play")) state.playing = !state.playing;
  ImGui::SameLine();
  constexpr double kSlowest = 0.2, kFastest = 60.0;
  ImGui::SetNextItemWidth(ImGui::CalcItemWidth() - ImGui::GetCursorPosX() +
                          ImGui::GetStyle().WindowPadding.x);
  (void)slider("steps a second", state.play_rate, kSlowest, kFastest, "%.1f", ImGuiSliderFlags_Logarithmic);
}

void choose_plotted(PanelState& state, const SceneInfo& info) {
  if (info.plotted.empty()) return;
  const char* kNothing = "nothing";
  if (ImGui::BeginCombo("plot at the probe", state.plotted.empty() ? kNothing : state.plotted.c_str())) {
    if (ImGui::Selectable(kNothing, state.plotted.empty())) state.plotted.clear();
    for (const std::string& name : info.plotted)
      if (ImGui::Selectable(name.c_str(), name == state.plotted)) state.plotted = name;
    ImGui::EndCombo();
  }
  if (state.plotted.empty()) return;
  ImGui::Checkbox("keep all steps in memory", &state.keep_steps);
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("read once, then the curve follows the hand at once; else step by step");
}

}  // namespace palpate
