#include "common/app/window/volume_panel.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <imgui.h>

#include "common/app/window/lens_panel.h"
#include "common/app/window/panel_parts.h"
#include "common/app/window/plane_panel.h"
#include "common/app/window/readout_rows.h"
#include "common/app/window/region_transfer_editor.h"
#include "common/app/window/time_panel.h"
#include "common/base/text.h"

namespace palpate {
namespace {

void draw_rays(VolumeView& volume) {
  constexpr double kFewest = 0.5, kMost = 16.0;
  ImGui::SliderScalar("samples a voxel", ImGuiDataType_Double, &volume.samples_per_voxel, &kFewest, &kMost,
                      "%.1f", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  constexpr double kEven = 1.0, kFarthest = 8.0;
  ImGui::SliderScalar("fewer far off", ImGuiDataType_Double, &volume.far_sampling, &kEven, &kFarthest, "%.0f",
                      ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  ImGui::Checkbox("shading", &volume.shading);
}

/// Whether a lens shows what the editor of all lenses edits.
bool shows_shared(const Lens& lens) { return !lens.cut && !lens.own_transfer && lens.field == 0; }

/// What such lenses show; that of new ones where there are none.
EditedTransfer focus_of(const VolumeView& volume, const SceneState& scene) {
  const auto of = [](const Lens& lens) {
    return EditedTransfer{lens.transfer.value_or(ColorTransfer()), lens.regions};
  };
  for (const Lens& lens : volume.lenses) {
    if (shows_shared(lens) && (lens.transfer || lens.regions)) return of(lens);
  }
  return of(scene.look(0));
}

void set_focus(VolumeView& volume, const EditedTransfer& focus) {
  for (Lens& lens : volume.lenses) {
    if (!shows_shared(lens)) continue;
    lens.transfer = focus.colors;
    lens.regions = focus.regions;
  }
}

/// Which other scalars are there for lenses.
void choose_beside(SceneSettings& settings, const SceneInfo& info) {
  std::vector<std::string>& beside = settings.beside;
  if (info.fields.size() < 2 && beside.empty()) return;
  if (!ImGui::BeginCombo("fields for lenses",
                         beside.empty() ? "none" : counted(beside.size(), "field").c_str()))
    return;
  std::vector<std::string> names = info.fields;
  for (const std::string& name : beside) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);  // of other files
  }
  for (const std::string& name : names) {
    if (name == settings.field) continue;
    const auto there = std::find(beside.begin(), beside.end(), name);
    if (!ImGui::Selectable(name.c_str(), there != beside.end(), ImGuiSelectableFlags_DontClosePopups))
      continue;
    if (there != beside.end()) {
      beside.erase(there);
      break;
    }
    if (beside.size() + 1 < kMostFields) beside.push_back(name);
  }
  ImGui::EndCombo();
}

/// Of the volume that is shown, which is what grid's hand feels.
std::optional<double> value_at_probe(const PanelState& state) {
  if (state.touch == nullptr || !state.touch->readout().held) return std::nullopt;
  return state.touch->readout().scalar;
}

/// All scalars of the scene where the probe is.
void draw_values_at_probe(const PanelState& state, const VolumeView& volume) {
  if (volume.fields.empty() || state.touch == nullptr || !state.touch->readout().held) return;
  const Vec3 place = state.touch->readout().proxy;
  ReadoutRows rows("values");
  rows.add(state.settings.field.c_str(), "%s", short_number(volume.image->value_at(place)).c_str());
  for (const VolumeField& field : volume.fields)
    rows.add(field.name.c_str(), "%s", short_number(field.image->value_at(place)).c_str());
  rows.finish();
}

}  // namespace

void draw_volume(PanelState& state, const SceneState& scene, VolumeView& volume, PanelActions& actions) {
  section("VOLUME");
  choose_word("field", state.settings.field, scene.info->fields);
  draw_values_at_probe(state, volume);
  draw_time(state, scene.info->times);
  const ValueHistogram* const histogram = state.histogram.of(volume.image);
  EditedTransfer colors{volume.transfer, volume.regions};
  actions.save_transfer |=
      choose_transfer("colours", "from the histogram", state.settings.transfer, colors, volume.image,
                      state.histogram, state.transfer_file, value_at_probe(state));
  volume.transfer = std::move(colors.colors);
  volume.regions = std::move(colors.regions);
  draw_rays(volume);
  const bool has_planes = state.touch != nullptr && state.touch->planes();
  const auto of_hand = has_planes ? static_cast<std::size_t>(state.touch->planes()->poses.count) : 0;
  if (of_hand < volume.cuts.size()) {
    section("CUTS");
    edit_cuts(volume.cuts, of_hand);
  }
  if (!volume.cuts.empty()) {
    section("ON PLANES");
    edit_plane_images(volume, histogram);
  }
  if (state.region != nullptr) {
    section("REGION");
    actions.region = edit_region(*state.region, *volume.image);
  }
  section("LENSES");
  actions.lens =
      draw_lens_panel(volume, scene.looks, state.settings.field, scene.info->bounds, state.histogram);
  choose_beside(state.settings, *scene.info);
  if (volume.lenses.empty()) return;
  EditedTransfer focus = focus_of(volume, scene);
  const EditedTransfer before = focus;
  actions.save_focus |= choose_transfer("inside", "denser half", state.settings.focus, focus, volume.image,
                                        state.histogram, state.focus_file);
  if (!(focus == before)) set_focus(volume, focus);
}

void draw_anisotropy(PanelState& state, const SceneState& scene, VolumeView& volume, PanelActions& actions) {
  section("ANISOTROPY AS A VOLUME");
  ImGui::Checkbox("volume", &volume.shown);
  ImGui::SameLine(0.5F * ImGui::GetContentRegionAvail().x);
  ImGui::Checkbox("in colour", &volume.colored);
  const ValueHistogram* const histogram = state.histogram.of(volume.image);
  constexpr ValueSpan kAnisotropies{0.0, 1.0};
  if (volume.regions) {
    (void)draw_region_editor("anisotropy", state.histogram.places_of(volume.image), *volume.regions);
  } else {
    (void)draw_transfer_editor("anisotropy", kAnisotropies, histogram, volume.transfer);
  }
  draw_rays(volume);
  actions.lens = draw_lens_panel(volume, scene.looks, "FA", scene.info->bounds, state.histogram);
  if (volume.lenses.empty()) return;
  EditedTransfer focus = focus_of(volume, scene);
  ImGui::TextDisabled("inside lenses");
  const bool changed =
      focus.regions ? draw_region_editor("focus", state.histogram.places_of(volume.image), *focus.regions)
                    : draw_transfer_editor("focus", kAnisotropies, histogram, focus.colors);
  if (changed) set_focus(volume, focus);
}

}  // namespace palpate
