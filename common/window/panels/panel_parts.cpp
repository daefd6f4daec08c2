#include "common/window/panels/panel_parts.h"

#include <cmath>

#include "common/base/text.h"

namespace palpate {

void section(const char* name) {
  ImGui::Spacing();
  ImGui::TextDisabled("%s", name);
  ImGui::Separator();
}

bool choose_word(const char* label, std::string& chosen, const std::vector<std::string>& words) {
  bool changed = false;
  if (ImGui::BeginCombo(label, chosen.c_str())) {
    for (const std::string& word : words) {
      if (ImGui::Selectable(word.c_str(), word == chosen) && word != chosen) {
        chosen = word;
        changed = true;
      }
    }
    ImGui::EndCombo();
  }
  return changed;
}

bool decade_slider(const char* label, double& value, int lower, int upper) {
  int decade = static_cast<int>(std::lround(std::log10(value)));
  if (!ImGui::SliderInt(label, &decade, lower, upper, short_number(value).c_str(),
                        ImGuiSliderFlags_AlwaysClamp)) {
    return false;
  }
  value = std::pow(10.0, decade);
  return true;
}

}  // namespace palpate
