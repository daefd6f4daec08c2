#include "common/window/panels/panel.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include <imgui.h>

#include "common/window/panels/fixture_panel.h"
#include "common/window/panels/panel_parts.h"
#include "common/window/panels/picture_panels.h"
#include "common/window/panels/start_page.h"

namespace palpate {
namespace {

// What was open before; the line above says what is open now.
void draw_recent(const PanelState& state, PanelActions& actions) {
  const InputFiles& now = state.scene->info->files;
  const auto other = [&](const InputFiles& input) { return !(input == now); };
  if (std::none_of(state.recent.begin(), state.recent.end(), other)) return;
  if (!begin_combo("##recent", "open recent")) return;
  for (const InputFiles& input : state.recent) {
    if (!other(input)) continue;
    ImGui::PushID(&input);
    if (selectable(name_of(input).c_str())) actions.open = input;
    hint("%s", input.files.front().string().c_str());
    ImGui::PopID();
  }
  ImGui::EndCombo();
}

void draw_input(const SceneState& scene, PanelActions& actions) {
  const ImVec2 place = ImGui::GetCursorPos();
  const bool unfolded = section("INPUT");
  const ImVec2 below = ImGui::GetCursorPos();
  // Beside the heading.
  ImGui::SetCursorPos({ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize("Open…").x -
                           2.0F * ImGui::GetStyle().FramePadding.x,
                       place.y + ImGui::GetStyle().ItemSpacing.y});
  actions.ask_to_open |= small_button("Open…");
  hint("other data, or a session (Ctrl+O); Ctrl+N shows recent files and examples");
  ImGui::SetCursorPos(below);
  if (!unfolded) return;
  ImGui::TextWrapped("%s", scene.info->name.c_str());
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  for (const std::string& fact : scene.info->facts) ImGui::TextWrapped("%s", fact.c_str());
  ImGui::PopStyleColor();
}

void draw_line_appearance(LineStyle& style) {
  edit_setting("line-width", style.width);
  edit_setting("line-opacity", style.opacity);
  edit_setting("halos", style.halo);
  ImGui::SameLine(0.5F * ImGui::GetContentRegionAvail().x);
  edit_setting("depth-cue", style.depth_cue);
}

void choose_background(Background& background) {
  constexpr std::array<const char*, 3> kNames{"dark", "light", "a colour"};
  int chosen = background == Background::kDark ? 0 : background == Background::kLight ? 1 : 2;
  if (combo("background", &chosen, kNames.data(), static_cast<int>(kNames.size()))) {
    const Rgb middle = 0.5F * (background.top + background.bottom);
    background = chosen == 0   ? Background::kDark
                 : chosen == 1 ? Background::kLight
                               : Background{middle, middle};
  }
  explain("background");
  if (chosen != 2) return;
  if (color_edit("##background", &background.top.x)) background.bottom = background.top;
}

void draw_appearance(SceneView& view, PanelActions& actions) {
  if (!section("APPEARANCE")) return;
  const bool lines = view.lines && !view.lines->empty();
  if (lines || (!view.volume && !view.tensors && !view.tracts)) draw_line_appearance(view.style);
  const float half = 0.5F * ImGui::GetContentRegionAvail().x;
  bool perspective = view.camera.projection == Projection::kPerspective;
  edit_setting("outline", view.show_outline);
  ImGui::SameLine(half);
  edit_setting("axes", view.show_axes);
  edit_setting("color-bar", view.show_color_bar);
  ImGui::SameLine(half);
  if (checkbox("perspective", &perspective)) {
    view.camera.projection = perspective ? Projection::kPerspective : Projection::kOrthographic;
  }
  hint("else lines that are parallel stay parallel");
  if (view.show_color_bar) {
    std::string side = view.color_bar_left ? "left" : "right";
    if (edit_setting("color-bar-side", side)) view.color_bar_left = side == "left";
  }
  edit_setting("scale-bar", view.show_scale_bar);
  input_text("caption", &view.caption);
  explain("caption");
  choose_background(view.background);
  ImGui::Spacing();
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 size{0.5F * (ImGui::GetContentRegionAvail().x - gap), 0.0F};
  constexpr std::array kLooks{std::pair{"x", Command::kLookAlongX}, std::pair{"y", Command::kLookAlongY},
                              std::pair{"z", Command::kLookAlongZ}};
  for (const auto& [axis, command] : kLooks) {
    if (button(axis, ImVec2{(size.x - 2.0F * gap) / 3.0F, 0.0F})) actions.look = command;
    ImGui::SameLine();
  }
  ImGui::TextUnformatted("view along");
  hint("an axis of the data; again: from the other side (F5, F6, F7)");
  actions.reset_camera |= button("Reset view", size);
  hint("all there is, from the first side (Enter)");
  ImGui::SameLine();
  actions.save_picture |= button("Save picture", size);
  hint("as it is seen, under the next free number (P)");
  actions.save_session |= button("Save session", size);
  hint("what is open, and how it is drawn and touched (Ctrl+S; Ctrl+Shift+S: under another name)");
  ImGui::SameLine();
  actions.export_picture |= button("Export picture…", size);
  hint("in another size, on another background or none (Shift+P)");
}

void draw_job(const Progress& job, PanelActions& actions) {
  const double fraction = job.fraction();
  const std::string stage = job.stage().empty() ? "working" : job.stage();
  if (fraction < 0.0) {
    // Unknown length: a bar that fills up with time and starts again.
    const auto seconds = static_cast<float>(job.seconds_in_stage());
    ImGui::ProgressBar(seconds - std::floor(seconds), {-FLT_MIN, 0.0F}, stage.c_str());
  } else {
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), "%s %.0f %%", stage.c_str(), 100.0 * fraction);
    ImGui::ProgressBar(static_cast<float>(fraction), {-FLT_MIN, 0.0F}, text.data());
  }
  actions.cancel |= button("Cancel", {-FLT_MIN, 0.0F});
}

void draw_panel(std::span<const PanelPart> parts, PanelState& state, SceneView& view,
                const WindowLayout& layout, PanelActions& actions) {
  ImGui::SetNextWindowPos({0.0F, 0.0F});
  ImGui::SetNextWindowSize({static_cast<float>(layout.panel_width),
                            static_cast<float>(layout.picture.height + layout.status_height)});
  ImGui::Begin("panel", nullptr, kFixedPanel);
  ImGui::PushItemWidth(0.62F * ImGui::GetContentRegionAvail().x);
  if (state.job != nullptr) draw_job(*state.job, actions);
  if (state.scene != nullptr) {
    draw_input(*state.scene, actions);
    draw_recent(state, actions);
    const bool touch = state.touch != nullptr && state.touch->available();
    if (touch) actions.touch = draw_acts(*state.touch, state.grabbed);
    PanelContext on{state, *state.scene, view, actions, layout.picture};
    for (const PanelPart& part : parts) part(on);
    if (touch) {
      if (section("TOUCH"))
        draw_touch_panel(*state.touch, state.lines_file, view, state.marking, actions.touch);
      draw_force_panel(*state.touch, state.grabbed);
      draw_fixture_panel(*state.touch, state.fixture);
    }
    draw_appearance(view, actions);
    for (const auto* notes : {&state.scene->notes, &state.scene->volume_notes}) {
      for (const std::string& note : *notes) {
        ImGui::Spacing();
        ImGui::TextWrapped("%s", note.c_str());
      }
    }
  }
  ImGui::Spacing();
  ImGui::TextDisabled("H  keys    /  search    Tab  hides this");
  ImGui::PopItemWidth();
  ImGui::End();
}

}  // namespace

WindowLayout layout(int width, int height, float text_height, bool panel) {
  WindowLayout result;
  // A narrow window keeps at least half of its width for the picture.
  if (panel) result.panel_width = std::min(std::round(21.0 * text_height), std::floor(0.5 * width));
  result.status_height = std::round(2.4 * text_height);
  result.picture = {result.panel_width, 0.0, std::max(1.0, width - result.panel_width),
                    std::max(1.0, height - result.status_height)};
  return result;
}

PanelActions draw_panels(std::span<const PanelPart> parts, PanelState& state, SceneView& view,
                         const WindowLayout& layout) {
  PanelActions actions;
  begin_controls();
  if (state.show_panel) {
    draw_panel(parts, state, view, layout, actions);
  } else if (state.job != nullptr) {
    constexpr float kWidth = 20.0F;  // heights of the text
    ImGui::SetNextWindowPos({ImGui::GetFontSize(), ImGui::GetFontSize()});
    ImGui::SetNextWindowSize({kWidth * ImGui::GetFontSize(), 0.0F});
    ImGui::Begin("job", nullptr, kFixedPanel | ImGuiWindowFlags_AlwaysAutoResize);
    draw_job(*state.job, actions);
    ImGui::End();
  }
  if (state.series && state.scene != nullptr) {
    actions.time = draw_series_plot(*state.series, series_plot_area(layout.picture, ImGui::GetFontSize()),
                                    state.scene->info->units);
  }
  draw_picture_panels(state, layout);
  return actions;
}

}  // namespace palpate
