#include "common/window/panels/panel_parts.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdarg>
#include <string_view>
#include <utility>

#include <imgui_stdlib.h>

#include "common/base/check.h"
#include "common/base/text.h"
#include "common/scene/document/setting.h"

namespace palpate {
namespace {

/// Of the last frame, and of the one that is being drawn: one thread draws panels, as Dear ImGui has it.
struct Drawn {
  std::vector<DrawnControl> last, now;
};
Drawn& drawn() {
  static Drawn all;
  return all;
}

/// Where a control that has its label beside it is drawn next, without that.
struct NextFrame {
  ImVec2 corner = ImGui::GetCursorScreenPos(), size{ImGui::CalcItemWidth(), ImGui::GetFrameHeight()};

  /// Notes it, and hands on what it returned.
  [[nodiscard]] bool noted(const char* label, bool returned) const {
    note_control(label, corner, size);
    return returned;
  }
};

/// Labels of panels begin small, but for abbreviations.
std::string label_of(const Setting& row) {
  std::string label = row.label();
  const auto is_capital = [](char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; };
  if (label.size() < 2 || !is_capital(label[1]))
    label.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(label.front())));
  return label;
}

const Range& reach_of(const Setting& row) {
  const Range& reach = std::isfinite(row.slider.upper) ? row.slider : row.range;
  PALPATE_CHECK(std::isfinite(reach.lower) && std::isfinite(reach.upper));
  return reach;
}

ImGuiSliderFlags flags_of(const Setting& row) {
  return ImGuiSliderFlags_AlwaysClamp | (row.log_slider ? ImGuiSliderFlags_Logarithmic : 0);
}

/// printf's format for numbers of this reach, with the unit where there is room for it.
std::string format_of(const Setting& row) {
  constexpr std::size_t kLongest = 5;
  const int digits = static_cast<int>(std::floor(std::log10(reach_of(row).upper)));
  const std::string unit = row.unit.empty() || row.unit.size() > kLongest ? "" : " " + std::string(row.unit);
  return "%." + std::to_string(std::clamp(2 - digits, 0, 2)) + "f" + unit;
}

/// Notes what was drawn last, and hands on what it returned.
bool noted(const char* label, bool returned) {
  note_control(label);
  return returned;
}

}  // namespace

void note_control(const char* label, const ImVec2& corner, const ImVec2& size) {
  std::string name(label);
  for (const char* end : {"##", "  ("}) {
    if (const std::size_t at = name.find(end); at != std::string::npos && at > 0) name.resize(at);
  }
  drawn().now.push_back({std::move(name), corner.x, corner.y, size.x, size.y});
}

void note_control(const char* label) {
  note_control(label, ImGui::GetItemRectMin(), ImGui::GetItemRectSize());
}

const std::vector<DrawnControl>& drawn_controls() noexcept { return drawn().last; }

void begin_controls() {
  drawn().last = std::move(drawn().now);
  drawn().now.clear();
}

bool button(const char* label, const ImVec2& size) { return noted(label, ImGui::Button(label, size)); }

bool small_button(const char* label) { return noted(label, ImGui::SmallButton(label)); }

bool checkbox(const char* label, bool* on) { return noted(label, ImGui::Checkbox(label, on)); }

bool selectable(const char* label, bool selected, ImGuiSelectableFlags flags) {
  return noted(label, ImGui::Selectable(label, selected, flags));
}

bool begin_combo(const char* label, const char* preview) {
  const NextFrame frame;
  return frame.noted(label, ImGui::BeginCombo(label, preview));
}

bool combo(const char* label, int* chosen, const char* const words[], int count) {
  if (!begin_combo(label, words[*chosen])) return false;
  bool changed = false;
  for (int i = 0; i < count; ++i) {
    if (!selectable(words[i], i == *chosen)) continue;
    changed = i != *chosen;
    *chosen = i;
  }
  ImGui::EndCombo();
  return changed;
}

bool slider_int(const char* label, int* value, int lower, int upper, const char* format,
                ImGuiSliderFlags flags) {
  const NextFrame frame;
  return frame.noted(label, ImGui::SliderInt(label, value, lower, upper, format, flags));
}

bool slider_scalar(const char* label, ImGuiDataType type, void* value, const void* lower, const void* upper,
                   const char* format, ImGuiSliderFlags flags) {
  const NextFrame frame;
  return frame.noted(label, ImGui::SliderScalar(label, type, value, lower, upper, format, flags));
}

bool input_text(const char* label, std::string* text, ImGuiInputTextFlags flags) {
  const NextFrame frame;
  return frame.noted(label, ImGui::InputText(label, text, flags));
}

bool input_numbers(const char* label, double* values, int count, const char* format,
                   ImGuiInputTextFlags flags) {
  const NextFrame frame;
  return frame.noted(label, ImGui::InputScalarN(label, ImGuiDataType_Double, values, count, nullptr, nullptr,
                                                format, flags));
}

bool drag_int(const char* label, int* values, int count, float speed, int lower, int upper,
              ImGuiSliderFlags flags) {
  const NextFrame frame;
  return frame.noted(label, ImGui::DragScalarN(label, ImGuiDataType_S32, values, count, speed, &lower, &upper,
                                               "%d", flags | ImGuiSliderFlags_AlwaysClamp));
}

bool color_edit(const char* label, float color[3], ImGuiColorEditFlags flags) {
  const NextFrame frame;
  return frame.noted(label, ImGui::ColorEdit3(label, color, flags));
}

void hint(const char* format, ...) {
  if (!ImGui::IsItemHovered()) return;
  std::va_list values;
  va_start(values, format);
  ImGui::SetTooltipV(format, values);
  va_end(values);
}

void explain(const char* setting_name) {
  // Behind a list that is open, its words were drawn last.
  std::vector<DrawnControl>& now = drawn().now;
  const std::string label = label_of(setting(setting_name));
  const auto own = std::find_if(now.rbegin(), now.rend(),
                                [&label](const DrawnControl& control) { return control.label == label; });
  if (own != now.rend())
    own->setting = setting_name;
  else if (!now.empty())
    now.back().setting = setting_name;
  if (!ImGui::IsItemHovered()) return;
  constexpr float kWidth = 28.0F;  // heights of the text
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(kWidth * ImGui::GetFontSize());
  ImGui::TextUnformatted(setting(setting_name).full_help().c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

bool edit_setting(const char* setting_name, double& value, double units) {
  const Setting& row = setting(setting_name);
  const Range& reach = reach_of(row);
  double shown = units * value;
  const bool changed = slider_scalar(label_of(row).c_str(), ImGuiDataType_Double, &shown, &reach.lower,
                                     &reach.upper, format_of(row).c_str(), flags_of(row));
  explain(setting_name);
  if (changed) value = shown / units;
  return changed;
}

bool edit_setting(const char* setting_name, int& value) {
  const Setting& row = setting(setting_name);
  const Range& reach = reach_of(row);
  const bool changed = slider_int(label_of(row).c_str(), &value, static_cast<int>(reach.lower),
                                  static_cast<int>(reach.upper), "%d", flags_of(row));
  explain(setting_name);
  return changed;
}

bool edit_setting(const char* setting_name, bool& on) {
  const bool changed = checkbox(label_of(setting(setting_name)).c_str(), &on);
  explain(setting_name);
  return changed;
}

bool edit_setting(const char* setting_name, std::string& word) {
  const Setting& row = setting(setting_name);
  const std::vector<std::string_view> words = row.word_list();
  const bool changed = choose_word(label_of(row).c_str(), word, {words.begin(), words.end()});
  explain(setting_name);
  return changed;
}

void section(const char* name) {
  ImGui::Spacing();
  ImGui::TextDisabled("%s", name);
  ImGui::Separator();
}

bool choose_word(const char* label, std::string& chosen, const std::vector<std::string>& words) {
  bool changed = false;
  if (begin_combo(label, chosen.c_str())) {
    for (const std::string& word : words) {
      if (selectable(word.c_str(), word == chosen) && word != chosen) {
        chosen = word;
        changed = true;
      }
    }
    ImGui::EndCombo();
  }
  return changed;
}

bool decade_slider(const char* label, double& value, int lower, int upper) {
  double shown = value;
  // As many digits as the least value needs: by them Dear ImGui tells it from zero.
  const bool moved = slider(label, shown, std::pow(10.0, lower), std::pow(10.0, upper), "%.12g",
                            ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_NoRoundToFormat);
  if (!moved) return false;
  if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) shown = std::pow(10.0, std::round(std::log10(shown)));
  return std::exchange(value, shown) != shown;
}

}  // namespace palpate
