#include "common/window/panels/panel_parts.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdarg>
#include <cstdlib>
#include <functional>
#include <map>
#include <set>
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
  std::set<std::string, std::less<>> settings_last, settings_now;
  std::map<std::string, std::string, std::less<>> section_of;  ///< of each setting, as it was drawn last
  struct Fold {
    bool folded = false;
    bool chosen = false;  ///< by a click or a search, after which it stays
  };
  std::map<std::string, Fold, std::less<>> folds;  ///< by section
  std::string section;                             ///< that is being drawn
  std::string target;                              ///< setting that is being gone to; empty: none
  bool in_sight = false;                           ///< it has been scrolled to
  std::string marked;                              ///< setting that was gone to last
  double marked_until = 0.0;                       ///< [s] of Dear ImGui's clock
  struct Sought {
    std::string label;
    int which = 0;   ///< of several of that label
    int frames = 0;  ///< since it was first asked for
  } sought;
  std::string reset;
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

/// Offers the default of the setting whose control was drawn last. @return whether it is asked for.
bool offer_default(const char* setting_name) {
  if (!ImGui::BeginPopupContextItem((std::string("default ") + setting_name).c_str())) return false;
  const Setting& row = setting(setting_name);
  std::string value = default_text(row);
  if (value.empty()) value = row.otherwise.empty() ? "as found" : std::string(row.otherwise);
  if (!row.unit.empty() && !default_text(row).empty()) value += " " + std::string(row.unit);
  const bool asked = noted("Reset to default", ImGui::Selectable(("Reset to default: " + value).c_str()));
  ImGui::EndPopup();
  return asked;
}

/// Of the control that was drawn last: where it is, its help, its default. @return whether that is asked for.
bool explained(const Setting& row, bool resets) {
  const std::string setting_name(row.name);
  Drawn& all = drawn();
  // Behind a list that is open, its words were drawn last.
  const std::string label = label_of(row);
  const auto own = std::find_if(all.now.rbegin(), all.now.rend(),
                                [&label](const DrawnControl& control) { return control.label == label; });
  if (own != all.now.rend())
    own->setting = setting_name;
  else if (!all.now.empty())
    all.now.back().setting = setting_name;
  all.settings_now.emplace(setting_name);
  all.section_of[setting_name] = all.section;
  if (all.target == setting_name) {
    ImGui::SetScrollHereY();
    if (std::exchange(all.in_sight, true)) {
      constexpr double kSeconds = 4.0;
      ImGui::SetKeyboardFocusHere(-1);
      all.marked = std::exchange(all.target, {});
      all.marked_until = ImGui::GetTime() + kSeconds;
    }
  }
  if (all.marked == setting_name && ImGui::GetTime() < all.marked_until) {
    const ImVec2 corner = ImGui::GetItemRectMin(), across = ImGui::GetItemRectMax();
    constexpr float kAround = 3.0F;  // [pixels]
    ImGui::GetForegroundDrawList()->AddRect({corner.x - kAround, corner.y - kAround},
                                            {across.x + kAround, across.y + kAround},
                                            ImGui::GetColorU32(ImGuiCol_CheckMark), kAround, 0, 2.0F);
  }
  const bool asked = resets && offer_default(setting_name.c_str());
  explain_setting(row);
  return asked;
}

/// The same of a control that takes the default itself, where the table says what it is.
bool resets(const char* setting_name) {
  if (!explained(setting(setting_name), true)) return false;
  if (!default_text(setting(setting_name)).empty()) return true;
  drawn().reset = setting_name;
  return false;
}

}  // namespace

std::string label_of(const Setting& row) {
  std::string label = row.label();
  const auto is_capital = [](char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; };
  if (label.size() < 2 || !is_capital(label[1]))
    label.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(label.front())));
  return label;
}

void note_control(const char* label, const ImVec2& corner, const ImVec2& size) {
  std::string name(label);
  for (const char* end : {"##", "  ("}) {
    if (const std::size_t at = name.find(end); at != std::string::npos && at > 0) name.resize(at);
  }
  Drawn& all = drawn();
  const ImVec2 middle{corner.x + 0.5F * size.x, corner.y + 0.5F * size.y};
  const bool in_sight =
      ImGui::IsRectVisible({middle.x - 1.0F, middle.y - 1.0F}, {middle.x + 1.0F, middle.y + 1.0F});
  if (!in_sight && name == all.sought.label &&
      std::ranges::count(all.now, name, &DrawnControl::label) == all.sought.which)
    ImGui::SetScrollFromPosY(middle.y - ImGui::GetWindowPos().y);
  all.now.push_back({std::move(name), corner.x, corner.y, size.x, size.y, {}, in_sight});
}

void note_control(const char* label) {
  note_control(label, ImGui::GetItemRectMin(), ImGui::GetItemRectSize());
}

const std::vector<DrawnControl>& drawn_controls() noexcept { return drawn().last; }

bool scrolls_to_control(const std::string& label, int which) {
  constexpr int kMost = 4;  // frames: one to ask, one to scroll, one to draw it there
  Drawn::Sought& sought = drawn().sought;
  int before = 0;
  for (const DrawnControl& control : drawn_controls()) {
    if (control.label != label || before++ < which) continue;
    if (control.in_sight) break;
    if (sought.label != label || sought.which != which) sought = {label, which};
    return ++sought.frames <= kMost;
  }
  sought = {};
  return false;
}

void begin_controls() {
  Drawn& all = drawn();
  all.last = std::move(all.now);
  all.now.clear();
  all.settings_last = std::move(all.settings_now);
  all.settings_now.clear();
  all.section.clear();
}

std::string shortened(std::string words, float room) {
  if (ImGui::CalcTextSize(words.c_str()).x <= room) return words;
  while (!words.empty() && ImGui::CalcTextSize((words + "…").c_str()).x > room) {
    // A character of several bytes goes as a whole.
    while (words.size() > 1 && (static_cast<unsigned char>(words.back()) & 0xC0U) == 0x80U) words.pop_back();
    words.pop_back();
  }
  return words + "…";
}

void forget_controls() { drawn() = {}; }

std::optional<std::string> place_of_setting(std::string_view name) {
  const Drawn& all = drawn();
  const auto known = all.section_of.find(name);
  if (known == all.section_of.end()) return std::nullopt;
  const auto fold = all.folds.find(known->second);
  const bool hidden = fold != all.folds.end() && fold->second.folded;
  if (!hidden && !all.settings_last.contains(name)) return std::nullopt;
  return known->second.empty() ? "panel" : known->second;
}

void go_to_setting(std::string_view name) {
  drawn().target = name;
  drawn().in_sight = false;
}

std::optional<std::string> take_reset() {
  std::string name = std::exchange(drawn().reset, {});
  return name.empty() ? std::nullopt : std::optional(std::move(name));
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

void explain_setting(const Setting& row) {
  if (!ImGui::IsItemHovered()) return;
  constexpr float kWidth = 28.0F;  // heights of the text
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(kWidth * ImGui::GetFontSize());
  ImGui::TextUnformatted(row.full_help().c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

void explain(const char* setting_name, bool resets) {
  if (explained(setting(setting_name), resets)) drawn().reset = setting_name;
}

void explain(const Setting& row) { (void)explained(row, false); }

bool edit_setting(const char* setting_name, double& value, double units) {
  const Setting& row = setting(setting_name);
  const Range& reach = reach_of(row);
  double shown = units * value;
  bool changed = slider_scalar(label_of(row).c_str(), ImGuiDataType_Double, &shown, &reach.lower,
                               &reach.upper, format_of(row).c_str(), flags_of(row));
  if (resets(setting_name)) {
    shown = std::strtod(default_text(row).c_str(), nullptr);
    changed = true;
  }
  if (changed) value = shown / units;
  return changed;
}

bool edit_setting(const char* setting_name, int& value) {
  const Setting& row = setting(setting_name);
  const Range& reach = reach_of(row);
  const bool changed = slider_int(label_of(row).c_str(), &value, static_cast<int>(reach.lower),
                                  static_cast<int>(reach.upper), "%d", flags_of(row));
  if (!resets(setting_name)) return changed;
  value = std::atoi(default_text(row).c_str());
  return true;
}

bool edit_setting(const char* setting_name, bool& on) {
  const Setting& row = setting(setting_name);
  const bool changed = checkbox(label_of(row).c_str(), &on);
  if (!resets(setting_name)) return changed;
  on = default_text(row) == "on";
  return true;
}

bool edit_setting(const char* setting_name, std::string& word) {
  const Setting& row = setting(setting_name);
  const std::vector<std::string_view> words = row.word_list();
  const bool changed = choose_word(label_of(row).c_str(), word, {words.begin(), words.end()});
  if (!resets(setting_name)) return changed;
  word = default_text(row);
  return true;
}

void center_next_window() {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5F * window.x, 0.5F * window.y}, ImGuiCond_Always, {0.5F, 0.5F});
}

bool section(const char* name, bool folded_unasked, std::initializer_list<const char*> settings) {
  Drawn& all = drawn();
  all.section = name;
  const auto [entry, first] = all.folds.try_emplace(name);
  auto& [folded, chosen] = entry->second;
  if (first) {
    for (const char* setting : settings) all.section_of.try_emplace(setting, name);
  }
  if (!chosen) folded = folded_unasked;
  if (const auto target = all.section_of.find(all.target);
      target != all.section_of.end() && target->second == name) {
    folded = false;
    chosen = true;
  }
  ImGui::Spacing();
  constexpr float kShare = 0.6F;  // of the row: there may be a button in the rest
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float em = ImGui::GetFontSize();
  const ImVec2 size{kShare * ImGui::GetContentRegionAvail().x, ImGui::GetTextLineHeight()};
  if (ImGui::InvisibleButton((std::string("##part ") + name).c_str(), size)) {
    folded = !folded;
    chosen = true;
  }
  note_control(name);
  const ImU32 ink = ImGui::GetColorU32(ImGui::IsItemHovered() ? ImGuiCol_Text : ImGuiCol_TextDisabled);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 mid{corner.x + 0.3F * em, corner.y + 0.5F * size.y};
  const float r = 0.25F * em;
  if (folded) {
    list.AddTriangleFilled({mid.x - r, mid.y - r}, {mid.x - r, mid.y + r}, {mid.x + r, mid.y}, ink);
  } else {
    list.AddTriangleFilled({mid.x - r, mid.y - r}, {mid.x + r, mid.y - r}, {mid.x, mid.y + r}, ink);
  }
  list.AddText({corner.x + em, corner.y}, ink, name);
  ImGui::Separator();
  return !folded;
}

void heading(const char* name) {
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
