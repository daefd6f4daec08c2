#include "common/window/panels/volume/volume_panel.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <imgui.h>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/window/panels/panel_parts.h"
#include "common/window/panels/panes_panel.h"
#include "common/window/panels/plane_panel.h"
#include "common/window/panels/time_panel.h"
#include "common/window/panels/volume/lens_panel.h"
#include "common/window/panels/volume/region_transfer_editor.h"

namespace palpate {
namespace {

/// Whether a lens shows what the editor of all lenses edits.
bool shows_shared(const Lens& lens) { return !lens.cut && !lens.own_transfer && lens.field == 0; }

/// Which other scalars are there for lenses, of those of the input, `fields`, and of other files.
/// @param field that is seen around lenses.
void choose_secondary(std::vector<std::string>& secondary, const std::string& field,
                      const std::vector<std::string>& fields) {
  if (fields.size() < 2 && secondary.empty()) return;
  if (!begin_combo("fields for lenses",
                   secondary.empty() ? "none" : counted(secondary.size(), "field").c_str()))
    return;
  std::vector<std::string> names = fields;
  for (const std::string& name : secondary) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);  // of other files
  }
  for (const std::string& name : names) {
    if (name == field) continue;
    const auto there = std::find(secondary.begin(), secondary.end(), name);
    if (!selectable(name.c_str(), there != secondary.end(), ImGuiSelectableFlags_DontClosePopups)) continue;
    if (there != secondary.end()) {
      secondary.erase(there);
      break;
    }
    if (secondary.size() + 1 < kMostFields) secondary.push_back(name);
  }
  ImGui::EndCombo();
}

/// Of the volume that is shown, which is what the hand feels.
std::optional<double> value_at_probe(const PanelState& state) {
  if (state.touch == nullptr || !state.touch->readout().held) return std::nullopt;
  return state.touch->readout().scalar;
}

}  // namespace

void draw_rays(VolumeView& volume) {
  edit_setting("samples", volume.samples_per_voxel);
  edit_setting("far-sampling", volume.far_sampling);
  edit_setting("shading", volume.shading);
  if (volume.shading) edit_setting("shadows", volume.shadows);
  edit_setting("illustration", volume.illustrated);
  if (!volume.lenses.empty()) edit_setting("context-fade", volume.context_fade);
}

EditedTransfer focus_of(const VolumeView& volume, const SceneState& scene) {
  const auto of = [](const Lens& lens) {
    return EditedTransfer{lens.transfer.value_or(ColorTransfer()), lens.regions};
  };
  for (const Lens& lens : volume.lenses) {
    if (shows_shared(lens) && (lens.transfer || lens.regions)) return of(lens);
  }
  return of(scene.appearance(0));
}

void set_focus(VolumeView& volume, const EditedTransfer& focus) {
  for (Lens& lens : volume.lenses) {
    if (!shows_shared(lens)) continue;
    lens.transfer = focus.colors;
    lens.regions = focus.regions;
  }
}

void draw_values_at_probe(const PanelState& state, const std::string& field, const VolumeView& volume) {
  if (state.touch == nullptr || !state.touch->readout().held) return;
  const Vec3 place = state.touch->readout().proxy;
  ReadoutRows rows("values");
  rows.add(field.c_str(), "%s", short_number(volume.image->value_at(place)).c_str());
  for (const VolumeField& other : volume.fields)
    rows.add(other.name.c_str(), "%s", short_number(other.image->value_at(place)).c_str());
  rows.finish();
}

void draw_volume_appearance(PanelState& state, const SceneState& scene, const std::string& field,
                            const std::vector<std::string>& fields, std::vector<std::string>& secondary,
                            std::optional<double> isovalue, VolumeView& volume, PanelActions& actions) {
  const ValueHistogram* const histogram = state.histogram.of(volume.image);
  EditedTransfer colors{volume.transfer, volume.regions};
  actions.save_transfer |=
      choose_transfer("colours", "transfer-function", "from the histogram", state.document.volume.transfer,
                      colors, volume.image, state.histogram, state.transfer_file, isovalue);
  volume.transfer = std::move(colors.colors);
  volume.regions = std::move(colors.regions);
  draw_rays(volume);
  const bool has_planes = state.touch != nullptr && state.touch->planes();
  const auto of_hand = has_planes ? as_size(state.touch->planes()->poses.count) : 0;
  if (of_hand < volume.cuts.size()) {
    if (section("CUTS")) edit_cuts(volume.cuts, of_hand);
  }
  if (!volume.cuts.empty()) {
    if (section("ON PLANES")) edit_plane_images(volume, histogram);
  }
  if (state.region != nullptr && scene.is_volume_alone()) {
    if (section("REGION")) actions.region = edit_region(*state.region, *volume.image);
  }
  if (!section("LENSES")) return;
  actions.lens = draw_lens_panel(volume, scene.appearances, field, scene.info->bounds, state.histogram);
  choose_secondary(secondary, field, fields);
  if (volume.lenses.empty()) return;
  EditedTransfer focus = focus_of(volume, scene);
  const EditedTransfer before = focus;
  actions.save_focus |= choose_transfer("inside", "focus-tf", "denser half", state.document.volume.focus,
                                        focus, volume.image, state.histogram, state.focus_file);
  if (!(focus == before)) set_focus(volume, focus);
}

void draw_volume(PanelContext& on) {
  if (!on.view.volume) return;
  PanelState& state = on.state;
  const SceneState& scene = on.scene;
  VolumeView& volume = *on.view.volume;
  if (section("VOLUME")) {
    choose_word("field", state.document.input.field, scene.info->fields);
    explain("field", false);
    if (!state.document.volume.resample.empty()) {
      std::string& resample = state.document.volume.resample;
      std::string typed = resample;
      if (input_text("resample", &typed, ImGuiInputTextFlags_EnterReturnsTrue)) resample = typed;
      explain("resample", false);
    }
    if (!volume.fields.empty()) draw_values_at_probe(state, state.document.input.field, volume);
    draw_time(state, scene.info->times);
  }
  edit_panes(volume, state.histogram.of(volume.image), on.view.anatomical);
  draw_volume_appearance(state, scene, state.document.input.field, scene.info->fields,
                         state.document.input.secondary, value_at_probe(state), volume, on.actions);
}

}  // namespace palpate
