#include "common/window/panels/fixture_panel.h"

#include <algorithm>
#include <cfloat>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include <imgui.h>

#include "common/base/index.h"
#include "common/hand/mode/fixture.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {
namespace {

/// A file by its name alone.
std::string shown_fixture(const std::string& text) {
  if (text == "mode") return "the mode itself";
  const std::filesystem::path file(text);
  return text.find(':') == std::string::npos ? file.filename().string() : text;
}

void list_fixtures(std::vector<std::string>& fixtures) {
  std::optional<std::size_t> removed, raised;
  for (std::size_t i = 0; i < fixtures.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (small_button("x##fixture")) removed = i;
    hint("take it out");
    ImGui::SameLine();
    ImGui::BeginDisabled(i == 0);
    if (small_button("^##fixture")) raised = i;
    ImGui::EndDisabled();
    hint(
        "before the one above: a hand feels the first of them, and each feels what the one before leaves free");
    ImGui::SameLine();
    ImGui::TextUnformatted(shown_fixture(fixtures[i]).c_str());
    hint("%s", fixtures[i].c_str());
    ImGui::PopID();
  }
  if (raised) std::swap(fixtures[*raised - 1], fixtures[*raised]);
  if (removed) fixtures.erase(fixtures.begin() + static_cast<std::ptrdiff_t>(*removed));
}

bool in_use(const TouchChoice& choice) {
  const ChainSettings& settings = choice.settings;
  const ContactSettings& contact = settings.contact;
  return !choice.fixtures.empty() || contact.sticking > 0.0 || contact.sliding > 0.0 || contact.grain > 0.0 ||
         settings.viscosity > 0.0 || settings.events.force > 0.0;
}

void edit_fixtures(TouchChoice& choice, const ProbeSession& session, std::string& typed) {
  std::vector<std::string>& fixtures = choice.fixtures;
  list_fixtures(fixtures);
  const float add_width = 3.5F * ImGui::GetFontSize();
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - 2.0F * add_width);
  const bool entered = input_text("##fixture", &typed, ImGuiInputTextFlags_EnterReturnsTrue);
  explain("fixture", false);
  ImGui::SameLine();
  ImGui::BeginDisabled(typed.empty());
  const bool added = button("Add##fixture") || entered;
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::TextUnformatted("fixture");
  if (added && !typed.empty()) {
    // Where the first stands behind the mode, the mode has a place of its own that can be moved.
    fixtures.push_back(typed);
    if (std::find(fixtures.begin(), fixtures.end(), "mode") == fixtures.end()) fixtures.emplace_back("mode");
    typed.clear();
  }
  if (!session.fixture_problem().empty()) ImGui::TextWrapped("%s", session.fixture_problem().c_str());
  for (const std::string& note : session.fixture_notes()) ImGui::TextWrapped("%s", note.c_str());

  ChainSettings& settings = choice.settings;
  if (!fixtures.empty()) {
    ShapeSettings& shape = settings.shape;
    if (edit_setting("fixture-snap", shape.snap_distance, kMillimetres))
      shape.release_distance = std::max(shape.release_distance, shape.snap_distance);
    if (edit_setting("fixture-release", shape.release_distance, kMillimetres))
      shape.snap_distance = std::min(shape.release_distance, shape.snap_distance);
    edit_setting("carry", settings.carry.speed, kMillimetres);
    if (settings.carry.speed > 0.0) edit_setting("carry-force", settings.carry.force);
  }
  ContactSettings& contact = settings.contact;
  if (edit_setting("static-friction", contact.sticking))
    contact.sliding = std::min(contact.sliding, contact.sticking);
  if (edit_setting("dynamic-friction", contact.sliding))
    contact.sticking = std::max(contact.sliding, contact.sticking);
  edit_setting("grain", contact.grain, kMillimetres);
  edit_setting("viscosity", settings.viscosity);
  edit_setting("even-stiffness", settings.even_stiffness);
  edit_setting("event-force", settings.events.force);
  if (settings.events.force > 0.0) edit_setting("event-frequency", settings.events.frequency);
}

}  // namespace

void draw_fixture_panel(ProbeSession& session, std::string& typed) {
  TouchChoice choice = session.choice();
  if (!section("FIXTURES", !in_use(choice),
               {"fixture", "static-friction", "dynamic-friction", "grain", "viscosity", "even-stiffness",
                "event-force"}))
    return;
  edit_fixtures(choice, session, typed);
  session.choose(choice);
}

}  // namespace palpate
