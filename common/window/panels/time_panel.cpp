#include "common/window/panels/time_panel.h"

#include <cstddef>
#include <string>

#include <imgui.h>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {

void draw_time(PanelState& state, const std::vector<double>& times) {
  if (times.size() < 2) return;
  const std::size_t now = time_step_of(state.document, times);
  int step = static_cast<int>(now);
  const int last = static_cast<int>(times.size()) - 1;
  // What is typed is the step, from 0.
  const std::string text = "%d:  t = " + short_number(times[now]);
  if (slider_int("time step", &step, 0, last, text.c_str(), ImGuiSliderFlags_AlwaysClamp)) {
    set_time_step(state.document, times, as_size(step));
  }
  if (small_button(state.playing ? "Stop###play" : "Play###play")) state.playing = !state.playing;
  ImGui::SameLine();
  ImGui::SetNextItemWidth(ImGui::CalcItemWidth() - ImGui::GetCursorPosX() +
                          ImGui::GetStyle().WindowPadding.x);
  edit_setting("play-rate", state.play_rate);
}

void choose_plotted(PanelState& state, const SceneInfo& info) {
  if (info.plotted.empty()) return;
  const char* kNothing = "nothing";
  if (begin_combo("plot at the probe", state.plotted.empty() ? kNothing : state.plotted.c_str())) {
    if (selectable(kNothing, state.plotted.empty())) state.plotted.clear();
    for (const std::string& name : info.plotted)
      if (selectable(name.c_str(), name == state.plotted)) state.plotted = name;
    ImGui::EndCombo();
  }
  if (state.plotted.empty()) return;
  checkbox("keep all steps in memory", &state.keep_steps);
  hint("read once, then the curve follows the hand at once; else step by step");
}

}  // namespace palpate
