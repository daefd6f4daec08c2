#include "common/window/panels/setting_search.h"

#include <algorithm>
#include <utility>

#include <imgui.h>

#include "common/base/text.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {
namespace {

/// 0 is the best; none where a word is nowhere.
std::optional<int> rank(const Setting& row, const std::vector<std::string>& words) {
  const std::string label = lowered(row.label()), name = lowered(row.name), help = lowered(row.help);
  int worst = 0;
  for (const std::string& word : words) {
    const auto in = [&](const std::string& text) { return text.find(word) != std::string::npos; };
    if (label.starts_with(word) || name.starts_with(word)) continue;
    if (!in(label) && !in(name) && !in(help)) return std::nullopt;
    worst = std::max(worst, in(label) || in(name) ? 1 : 2);
  }
  return worst;
}

}  // namespace

std::vector<const Setting*> find_settings(std::string_view typed, FieldKind kind) {
  std::vector<std::string> words;
  const std::string small = lowered(typed);
  for (const std::string_view word : split(small, ' ')) {
    if (!word.empty()) words.emplace_back(word);
  }
  std::vector<std::pair<int, const Setting*>> ranked;
  for (const Setting& row : settings()) {
    if (!row.saved || !row.kinds.has(kind)) continue;
    if (const auto found = rank(row, words)) ranked.emplace_back(*found, &row);
  }
  std::ranges::stable_sort(ranked, {}, &std::pair<int, const Setting*>::first);
  std::vector<const Setting*> found;
  for (const auto& [ignored, row] : ranked) found.push_back(row);
  return found;
}

void SettingSearch::open() {
  asking_ = takes_focus_ = true;
  chosen_ = false;
  typed_.clear();
  typed_before_.clear();
  current_ = 0;
}

bool SettingSearch::handle(const InputEvent& event) {
  if (!asking_) return false;
  if (event.kind == InputKind::kKeyDown) {
    scrolls_ = true;
    if (event.key == key_code::kEscape) asking_ = false;
    if (event.key == key_code::kEnter || event.key == key_code::kPadEnter) chosen_ = true;
    if (event.key == key_code::kDown && current_ + 1 < count_) ++current_;
    if (event.key == key_code::kUp && current_ > 0) --current_;
    return true;
  }
  return event.kind == InputKind::kKeyUp || event.kind == InputKind::kText || event.kind == InputKind::kWheel;
}

bool SettingSearch::draw_rows(const Document& document, const std::vector<const Setting*>& found) {
  const float em = ImGui::GetFontSize();
  bool pressed = false;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Setting& row = *found[i];
    ImGui::PushID(static_cast<int>(i));
    if (selectable(row.label().c_str(), i == current_)) {
      current_ = i;
      pressed = true;
    }
    if (i == current_ && std::exchange(scrolls_, false)) ImGui::SetScrollHereY();
    explain_setting(row);
    std::string value = value_text(row, document);
    if (value.empty()) value = std::string(row.otherwise);
    if (!row.unit.empty() && !value.empty()) value += " " + std::string(row.unit);
    ImGui::SameLine(15.0F * em);
    ImGui::TextDisabled("%s", shortened(value, 12.0F * em).c_str());
    ImGui::SameLine(28.0F * em);
    const auto place = place_of_setting(row.name);
    ImGui::TextDisabled("%s", place ? place->c_str() : row.option().c_str());
    ImGui::PopID();
  }
  return pressed;
}

std::optional<std::string> SettingSearch::draw(const Document& document, FieldKind kind) {
  if (!asking_) return std::nullopt;
  const float em = ImGui::GetFontSize();
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  constexpr float kWidth = 42.0F, kRows = 14.0F;  // heights of the text
  ImGui::SetNextWindowPos({0.5F * window.x, 4.0F * em}, ImGuiCond_Always, {0.5F, 0.0F});
  ImGui::SetNextWindowSize({std::min(kWidth * em, window.x - 2.0F * em), 0.0F});
  if (takes_focus_) ImGui::SetNextWindowFocus();
  ImGui::Begin("search", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_AlwaysAutoResize);
  if (std::exchange(takes_focus_, false)) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-8.0F * em);
  (void)input_text("search", &typed_);
  if (std::exchange(typed_before_, typed_) != typed_) current_ = 0;
  const std::vector<const Setting*> found = find_settings(typed_, kind);
  count_ = found.size();
  current_ = std::min(current_, count_ - std::min<std::size_t>(count_, 1));
  ImGui::BeginChild("found", {0.0F, kRows * ImGui::GetTextLineHeightWithSpacing()});
  if (draw_rows(document, found)) chosen_ = true;
  if (found.empty()) ImGui::TextDisabled("no setting is called so");
  ImGui::EndChild();
  ImGui::TextDisabled("Enter goes to the control, Esc leaves");
  // A click beside it leaves it.
  if (ImGui::IsMouseClicked(ImGuiMouseButton_Left) && !ImGui::IsWindowHovered(ImGuiHoveredFlags_ChildWindows))
    asking_ = false;
  ImGui::End();
  if (!std::exchange(chosen_, false) || found.empty()) return std::nullopt;
  asking_ = false;
  const Setting& row = *found[current_];
  if (place_of_setting(row.name)) {
    go_to_setting(row.name);
    return std::nullopt;
  }
  return row.label() + " has no control in the panel now; on the command line it is " + row.option();
}

}  // namespace palpate
