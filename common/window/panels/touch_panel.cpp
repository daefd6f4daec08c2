#include "common/window/panels/touch_panel.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include <imgui.h>

#include "common/base/text.h"
#include "common/hand/servo_rows.h"
#include "common/render/probe_view.h"
#include "common/window/panels/panel_parts.h"
#include "common/window/panels/plane_panel.h"
#include "common/window/panels/tensor_readout.h"
#include "common/window/panels/volume/curve_panel.h"
#include "common/window/panels/volume/isosurface_panel.h"

namespace palpate {
namespace {

void choose_mode(TouchChoice& choice, const std::vector<HapticMode>& modes) {
  const bool chooses = begin_combo("mode", modes[choice.mode].name.c_str());
  explain("mode", false);
  if (!chooses) return;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    if (selectable(modes[i].name.c_str(), i == choice.mode)) choice.mode = i;
    hint("%s", modes[i].summary.c_str());
  }
  ImGui::EndCombo();
}

bool forces_changed(const TouchChoice& choice) {
  const ChainSettings &now = choice.settings, plain;
  return choice.ticks || now.stiffness != plain.stiffness ||
         now.streamline.release_distance != plain.streamline.release_distance ||
         now.streamline.speed_force != plain.streamline.speed_force ||
         now.drag.threshold != plain.drag.threshold ||
         now.force_field.strength != plain.force_field.strength ||
         now.force_field.damping != plain.force_field.damping || now.ticks.stiffness != plain.ticks.stiffness;
}

void edit_forces(TouchChoice& choice, std::string_view mode, bool flow) {
  ChainSettings& settings = choice.settings;
  edit_setting("stiffness", settings.stiffness);
  if (flow) {
    edit_setting("release", settings.streamline.release_distance, kMillimetres);
    edit_setting("drag", settings.drag.threshold, kMillimetres);
  }
  if (mode == "direct" || mode == "vortex") edit_setting("field-force", settings.force_field.strength);
  if (mode == "transverse" || mode == kDensityMode)
    edit_setting("field-damping", settings.force_field.damping);
  if (!flow) return;
  edit_setting("speed-force", settings.streamline.speed_force);
  edit_setting("ticks", choice.ticks);
  if (choice.ticks) edit_setting("tick-stiffness", settings.ticks.stiffness);
}

void choose_stroke(StrokeUse& use) {
  constexpr std::array<std::pair<StrokeUse, const char*>, 2> kUses{
      {{StrokeUse::kAppend, "goes on from an end"}, {StrokeUse::kReplace, "replaces the last"}}};
  const bool chooses = begin_combo("a stroke", kUses[use == StrokeUse::kAppend ? 0 : 1].second);
  explain("stroke");
  if (!chooses) return;
  for (const auto& [each, words] : kUses) {
    if (selectable(words, each == use)) use = each;
  }
  ImGui::EndCombo();
}

/// The name of the file, and its ending for those who have only a mouse.
void choose_file(std::string& file, float width) {
  constexpr std::array<const char*, 5> kEndings{".tck", ".trk", ".trx", ".vtp", ".csv"};
  const float ending_width = 4.5F * ImGui::GetFontSize();
  std::filesystem::path path(file);
  const std::string ending = path.extension().string();
  ImGui::SetNextItemWidth(width - ending_width - ImGui::GetStyle().ItemSpacing.x);
  input_text("##file", &file);
  ImGui::SameLine();
  ImGui::SetNextItemWidth(ending_width);
  if (begin_combo("##ending", ending.c_str())) {
    for (const char* each : kEndings) {
      if (selectable(each, ending == each)) file = path.replace_extension(each).string();
    }
    ImGui::EndCombo();
  }
}

/// @param surfaces words for those that are felt; null: none are.
/// @param shown whether they are.
void choose_appearances(TouchChoice& choice, float half, bool flow, const char* surfaces, bool shown) {
  if (surfaces != nullptr && checkbox(surfaces, &shown)) choice.show_surface = shown;
  if (surfaces != nullptr) explain("show-surfaces");
  if (!flow) {
    edit_setting("show-path", choice.show_path);
    return;
  }
  edit_setting("stream-balls", choice.show_balls);
  ImGui::SameLine(half);
  edit_setting("show-path", choice.show_path);
  edit_setting("fade-lines", choice.fade_rest);
  edit_setting("local-lines", choice.local);
}

bool has_lines(const ProbeSession& session) {
  return session.data().has_flow() || session.data().has_wall() || session.data().has_tensors();
}

/// Rows of its own height, however many are kept: nothing below them moves.
void list_kept(ProbeSession& session) {
  constexpr float kRows = 3.0F;
  const DrawnLines& kept = session.trail().drawn_lines();
  ImGui::BeginChild("kept", {0.0F, kRows * ImGui::GetTextLineHeightWithSpacing()});
  if (kept.entries().empty())
    ImGui::TextDisabled(session.data().has_tensors() ? "no tract is kept" : "no line is kept");
  std::optional<std::size_t> removed;
  for (std::size_t i = 0; i < kept.entries().size(); ++i) {
    const DrawnLines::Entry& entry = kept.entries()[i];
    const Rgb color = cached_color(entry.number);
    ImGui::PushID(static_cast<int>(i));
    ImGui::TextColored({color.r, color.g, color.b, 1.0F}, "%d", entry.number);
    ImGui::SameLine();
    ImGui::Text("length %s, up to %.2f N", short_number(entry.line->points.back().arc).c_str(),
                entry.largest_force);
    ImGui::SameLine();
    if (small_button("x")) removed = i;
    hint("delete (Ctrl+Z takes it back)");
    ImGui::PopID();
  }
  // The last stays in sight when one is added.
  if (ImGui::GetScrollY() >= ImGui::GetScrollMaxY()) ImGui::SetScrollHereY(1.0F);
  ImGui::EndChild();
  if (removed) session.trail().remove_kept(*removed);
}

}  // namespace

TouchActions draw_acts(ProbeSession& session, bool grabbed) {
  TouchActions actions;
  const ImVec2 half{0.5F * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x), 0.0F};
  const bool tensors = session.data().has_tensors();
  const char* grab = tensors ? "Draw tracts  (G)" : "Grab  (G)";
  const char* let_go = tensors ? "Stop drawing  (G)" : "Let go  (G)";
  actions.grab = button((std::string(grabbed ? let_go : grab) + "###grab").c_str(), half);
  ImGui::SameLine();
  if (session.readout().servo.armed) {
    if (button("Force off  (F12)", half)) session.servo().force_off();
  } else if (button("Force on again", half)) {
    session.servo().arm();
  }
  if (has_lines(session)) {
    actions.keep = button(tensors ? "Keep tract  (K)" : "Keep line  (K)", half);
    if (tensors || session.planes()) ImGui::SameLine();
  }
  if (tensors || session.planes()) actions.undo = button("Undo  (Ctrl+Z)", half);
  if (session.servo().replaying()) {
    const std::string verdict = session.servo().replay_verdict();
    ImGui::TextWrapped("%s", verdict.empty() ? "replaying" : verdict.c_str());
  }
  return actions;
}

void draw_touch_panel(ProbeSession& session, std::string& file, SceneView& view, bool marking,
                      TouchActions& actions) {
  const float half_width = 0.5F * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
  const float half = 0.5F * ImGui::GetContentRegionAvail().x;
  const ImVec2 size{half_width, 0.0F};
  const bool tensors = session.data().has_tensors();
  TouchChoice choice = session.choice();
  choose_mode(choice, session.modes());
  edit_curves(choice, session.modes()[choice.mode].name, session);
  const HapticLevels levels = session.data().levels();
  edit_isosurfaces(choice.settings.isosurface, levels, session.data().surfaces(),
                   session.data().surfaces_fraction(), session.modes()[choice.mode].name,
                   session.data().has_flow());
  edit_texture(choice.settings.texture, session.modes()[choice.mode], session);
  edit_grid(choice, session.modes()[choice.mode].name, session, view.volume ? &view.volume->cuts : nullptr);
  if (tensors) choose_stroke(choice.stroke);
  const bool layers = session.modes()[choice.mode].name != kIsosurfaceMode;
  const char* const surfaces = layers ? "show haptic layers" : "show isosurface";
  choose_appearances(choice, half, session.data().has_flow(), levels.field ? surfaces : nullptr,
                     choice.show_surface.value_or(!session.data().has_wall()));
  session.choose(choice);
  edit_planes(session, view.camera, view.volume ? view.volume->cuts : std::span<CuttingPlane>());

  const bool clears = button(tensors ? "Clear drawing" : "Clear path", size);
  hint("what the hand has drawn and is not kept");
  if (clears) session.trail().clear_path();
  if (session.data().scalar() && !session.data().has_flow() && view.volume)
    edit_notes(session, *view.volume, marking, actions);
  if (!has_lines(session)) return;
  ImGui::BeginDisabled(session.trail().drawn_lines().entries().empty() && session.trail().drawn().empty());
  if (tensors) {
    choose_file(file, half_width + 2.0F * ImGui::GetFontSize());
    ImGui::SameLine();
    actions.save_lines = button("Save tracts", {-FLT_MIN, 0.0F});
  } else {
    ImGui::SetNextItemWidth(half_width);
    input_text("##file", &file);
    ImGui::SameLine();
    actions.save_lines = button("Save lines", size);
  }
  ImGui::EndDisabled();
  list_kept(session);
}

void draw_force_panel(ProbeSession& session, bool grabbed) {
  TouchChoice choice = session.choice();
  const bool folded = !grabbed && !session.hand().by_device() && !forces_changed(choice);
  if (!section("FORCES", folded,
               {"stiffness", "release", "drag", "field-force", "field-damping", "speed-force", "ticks"}))
    return;
  edit_forces(choice, session.modes()[choice.mode].name, session.data().has_flow());
  session.choose(choice);
  if (const std::string note = session.limits().note(session.choice().settings); !note.empty())
    ImGui::TextWrapped("%s", note.c_str());
}

float draw_probe_readout(const ProbeSession& session, const ValueHistogram* histogram, float left,
                         float top) {
  const ProbeReadout& readout = session.readout();
  if (!readout.held) return 0.0F;
  ImGui::SetNextWindowPos({left, top});
  ImGui::SetNextWindowBgAlpha(0.7F);
  constexpr ImGuiWindowFlags kFlags =
      ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
      ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs;
  ImGui::Begin("probe", nullptr, kFlags);
  const auto words = [](std::string_view name) {
    std::string text(name);
    std::replace(text.begin(), text.end(), '_', ' ');
    return text;
  };
  std::string state = words(name_of(readout.state));
  if (readout.cut != ForceCut::kNone) state += " (" + words(name_of(readout.cut)) + ")";
  ReadoutRows rows("readout");
  rows.add("probe", "%s", state.c_str());
  rows.add("at", "%.5g  %.5g  %.5g", readout.proxy.x, readout.proxy.y, readout.proxy.z);
  if (!readout.cell.empty()) rows.add("cell", "%s", readout.cell.c_str());
  if (readout.sampled) {
    rows.add("value", "%.4g  %.4g  %.4g", readout.velocity.x, readout.velocity.y, readout.velocity.z);
    rows.add("speed", "%.4g", glm::length(readout.velocity));
  } else if (session.data().has_flow()) {
    rows.add("value", "none here");
  }
  if (readout.tensor && session.data().has_tensors()) {
    add_tensor_rows(*readout.tensor, rows);
  } else if (readout.tensor) {
    add_fibre_rows(*readout.tensor, rows);
  } else if (session.data().has_tensors()) {
    rows.add("tensor", "none here");
  }
  if (readout.scalar) {
    rows.add(readout.scalar_name.c_str(), "%.5g", *readout.scalar);
    constexpr double kPercent = 100.0;
    if (histogram != nullptr)
      rows.add("values below", "%.1f %%", kPercent * part_below(*histogram, *readout.scalar));
    if (readout.noise) rows.add("noise", "%.2f %% of the range", kPercent * *readout.noise);
  } else if (!readout.scalar_name.empty()) {
    rows.add(readout.scalar_name.c_str(), "none here");
  }
  rows.add("force", "%.2f N", readout.force);
  rows.add("stretch", "%.2f mm", readout.stretch);
  if (readout.perceived_stiffness > 0.0) rows.add("feels like", "%.0f N/m", readout.perceived_stiffness);
  rows.add("residual", "%.1e", readout.residual);
  rows.finish();
  const float height = ImGui::GetWindowHeight();
  ImGui::End();
  return height;
}

void add_servo_rates(const ProbeSession& session, ReadoutRows& rows) {
  if (!session.available()) return;
  for (const ServoRow& row : servo_rows(session.readout().servo)) {
    rows.add(row.name.c_str(), "%s", row.value.c_str());
  }
  if (const std::string limit = session.limits().text(session.choice().settings); !limit.empty()) {
    rows.add("stiffness", "%s", limit.c_str());
  }
}

}  // namespace palpate
