#include "common/window/panels/banners.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

#include "common/base/text.h"
#include "common/window/panels/panel_parts.h"
#include "common/window/panels/picture_panels.h"

namespace palpate {
namespace {

/// Of lines and volume, each once.
std::vector<std::string> notes_of(const SceneState& scene) {
  std::vector<std::string> notes;
  for (const auto* each : {&scene.notes, &scene.volume_notes})
    std::ranges::copy_if(*each, std::back_inserter(notes), [&](const std::string& note) {
      return std::ranges::find(notes, note) == notes.end();
    });
  return notes;
}

enum class BannerChoice : std::uint8_t { kNone, kClose, kFix };

/// @param fixes whether there is something that mends it: Fix and Ignore are offered then.
BannerChoice draw_banner(const std::string& words, const ImVec4& color, const std::string& control,
                         float width, bool fixes = false) {
  const float em = ImGui::GetFontSize();
  ImGui::PushID(words.c_str());
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Indent(0.8F * em);
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width - 3.0F * em);
  ImGui::BeginGroup();
  ImGui::TextUnformatted(words.c_str());
  ImGui::EndGroup();
  ImGui::PopTextWrapPos();
  const float height = ImGui::GetItemRectSize().y;
  ImGui::GetWindowDrawList()->AddRectFilled(corner, {corner.x + 0.25F * em, corner.y + height},
                                            ImGui::ColorConvertFloat4ToU32(color));
  ImGui::SameLine(ImGui::GetWindowContentRegionMin().x + width - 1.4F * em);
  BannerChoice choice = small_button(control.c_str()) ? BannerChoice::kClose : BannerChoice::kNone;
  hint("close");
  if (fixes) {
    if (small_button("Fix")) choice = BannerChoice::kFix;
    hint("does what the warning advises; Ctrl+Z takes it back");
    ImGui::SameLine();
    if (small_button("Ignore")) choice = BannerChoice::kClose;
    hint("leaves everything as it is");
  }
  ImGui::Unindent(0.8F * em);
  ImGui::PopID();
  return choice;
}

const SceneFix* fix_of(const SceneState& scene, const std::string& note) {
  const auto at = std::ranges::find(scene.fixes, note, &SceneFix::note);
  return at == scene.fixes.end() ? nullptr : &*at;
}

void fix(const SceneFix& with, Document& document) {
  for (const auto& [name, text] : with.settings) {
    if (const Setting* const row = find_setting(name, document.input.kind)) set_value(*row, document, text);
  }
}

}  // namespace

void draw_banners(PanelState& state, const WindowLayout& layout) {
  constexpr std::size_t kMost = 3;
  std::vector<std::string> notes;
  std::size_t closed = 0;
  for (const std::string& note : state.scene != nullptr ? notes_of(*state.scene) : notes) {
    if (state.closed_notes.contains(note)) {
      ++closed;
    } else {
      notes.push_back(note);
    }
  }
  const bool error = !state.error.empty();
  if (notes.empty() && closed == 0 && !error) return;
  const float em = ImGui::GetFontSize();
  const PictureArea& area = layout.picture;
  constexpr float kAxes = 8.0F, kWidest = 52.0F;  // heights of the text
  constexpr float kNarrowest = 12.0F;
  const float width =
      std::clamp(static_cast<float>(area.width) - (kAxes + 3.0F) * em, kNarrowest * em, kWidest * em);
  const double foot = state.series ? series_plot_area(area, em).top : area.top + area.height;
  // Beside the axes.
  ImGui::SetNextWindowPos(
      {static_cast<float>(area.left + area.width) - 0.5F * em, static_cast<float>(foot) - 0.5F * em},
      ImGuiCond_Always, {1.0F, 1.0F});
  ImGui::SetNextWindowSizeConstraints({0.0F, 0.0F},
                                      {width + 2.0F * em, static_cast<float>(0.5 * area.height)});
  ImGui::SetNextWindowBgAlpha(0.92F);
  ImGui::Begin("banners", nullptr,
               kFixedPanel | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoScrollbar |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  const ImVec4 red{0.93F, 0.36F, 0.30F, 1.0F}, amber{0.93F, 0.67F, 0.20F, 1.0F};
  if (error && draw_banner(state.error, red, "x##error", width) == BannerChoice::kClose) state.error.clear();
  for (std::size_t i = 0; i < std::min(notes.size(), kMost); ++i) {
    const SceneFix* const mends = fix_of(*state.scene, notes[i]);
    const BannerChoice choice = draw_banner(notes[i], amber, "x##note", width, mends != nullptr);
    if (choice == BannerChoice::kFix) fix(*mends, state.document);
    if (choice == BannerChoice::kClose) state.closed_notes.insert(notes[i]);
  }
  if (notes.size() > kMost)
    ImGui::TextDisabled("and %s more, at the end of the panel",
                        counted(notes.size() - kMost, "note").c_str());
  if (closed > 0 && small_button((counted(closed, "note") + "###notes").c_str())) state.closed_notes.clear();
  if (closed > 0) hint("on what is shown");
  ImGui::End();
}

}  // namespace palpate
