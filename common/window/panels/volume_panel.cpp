#include "common/window/panels/volume_panel.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "common/base/text.h"
#include "common/window/panels/lens_panel.h"
#include "common/window/panels/panel_parts.h"
#include "common/window/panels/plane_panel.h"
#include "common/window/panels/readout_rows.h"
#include "common/window/panels/region_transfer_editor.h"
#include "common/window/panels/time_panel.h"

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

/// Which other scalars are there for lenses, of those of the input, `fields`, and of other files.
/// @param field that is seen around lenses.
void choose_beside(std::vector<std::string>& beside, const std::string& field,
                   const std::vector<std::string>& fields) {
  if (fields.size() < 2 && beside.empty()) return;
  if (!ImGui::BeginCombo("fields for lenses",
                         beside.empty() ? "none" : counted(beside.size(), "field").c_str()))
    return;
  std::vector<std::string> names = fields;
  for (const std::string& name : beside) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);  // of other files
  }
  for (const std::string& name : names) {
    if (name == field) continue;
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

/// Of the volume of a flow, in whose place its hand may feel something else.
std::optional<double> seen_at_probe(const PanelState& state, const VolumeView& volume) {
  if (state.touch == nullptr || !state.touch->readout().held) return std::nullopt;
  const double value = volume.image->value_at(state.touch->readout().proxy);
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// All scalars of the scene where the probe is.
void draw_values_at_probe(const PanelState& state, const std::string& field, const VolumeView& volume) {
  if (state.touch == nullptr || !state.touch->readout().held) return;
  const Vec3 place = state.touch->readout().proxy;
  ReadoutRows rows("values");
  rows.add(field.c_str(), "%s", short_number(volume.image->value_at(place)).c_str());
  for (const VolumeField& other : volume.fields)
    rows.add(other.name.c_str(), "%s", short_number(other.image->value_at(place)).c_str());
  rows.finish();
}

/// Colours, rays, cuts and lenses of a volume.
/// @param field name of what is seen around lenses. @param fields that there are. @param beside edited: those
/// for lenses. @param felt value at the probe.
void draw_volume_look(PanelState& state, const SceneState& scene, const std::string& field,
                      const std::vector<std::string>& fields, std::vector<std::string>& beside,
                      std::optional<double> felt, VolumeView& volume, PanelActions& actions) {
  const ValueHistogram* const histogram = state.histogram.of(volume.image);
  EditedTransfer colors{volume.transfer, volume.regions};
  actions.save_transfer |= choose_transfer("colours", "from the histogram", state.settings.transfer, colors,
                                           volume.image, state.histogram, state.transfer_file, felt);
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
  if (state.region != nullptr && scene.is_volume_alone()) {
    section("REGION");
    actions.region = edit_region(*state.region, *volume.image);
  }
  section("LENSES");
  actions.lens = draw_lens_panel(volume, scene.looks, field, scene.info->bounds, state.histogram);
  choose_beside(beside, field, fields);
  if (volume.lenses.empty()) return;
  EditedTransfer focus = focus_of(volume, scene);
  const EditedTransfer before = focus;
  actions.save_focus |= choose_transfer("inside", "denser half", state.settings.focus, focus, volume.image,
                                        state.histogram, state.focus_file);
  if (!(focus == before)) set_focus(volume, focus);
}

/// Which scalar of a flow is a volume, and from how many points. What lies on no image is resampled as soon
/// as it is chosen, which is what asks for it.
void choose_flow_volume(SceneSettings& settings, const SceneInfo& info) {
  constexpr const char* kNothing = "nothing";
  constexpr const char* kFirstTry = "64";
  std::vector<std::string>& volumes = settings.volumes;
  if (ImGui::BeginCombo("volume of", volumes.empty() ? kNothing : volumes.front().c_str())) {
    if (ImGui::Selectable(kNothing, volumes.empty())) volumes.clear();
    for (const std::string& name : info.volumes) {
      const bool chosen = !volumes.empty() && name == volumes.front();
      if (!ImGui::Selectable(name.c_str(), chosen) || chosen) continue;
      volumes.erase(std::remove(volumes.begin(), volumes.end(), name), volumes.end());
      if (!volumes.empty()) volumes.erase(volumes.begin());
      volumes.insert(volumes.begin(), name);
      settings.transfer.clear();  // of other values
      settings.focus.clear();
      if (info.resampled && settings.resample.empty()) settings.resample = kFirstTry;
    }
    ImGui::EndCombo();
  }
  if (volumes.empty()) return;
  std::string resample = settings.resample;
  if (ImGui::InputText("resample", &resample, ImGuiInputTextFlags_EnterReturnsTrue))
    settings.resample = resample;
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("points along the longest edge, or N,N,N; empty: those of an image");
}

}  // namespace

void draw_volume(PanelState& state, const SceneState& scene, VolumeView& volume, PanelActions& actions) {
  section("VOLUME");
  choose_word("field", state.settings.field, scene.info->fields);
  if (!volume.fields.empty()) draw_values_at_probe(state, state.settings.field, volume);
  draw_time(state, scene.info->times);
  draw_volume_look(state, scene, state.settings.field, scene.info->fields, state.settings.beside,
                   value_at_probe(state), volume, actions);
}

void draw_flow_volume(PanelState& state, const SceneState& scene, std::optional<VolumeView>& volume,
                      PanelActions& actions) {
  section("VOLUME");
  std::vector<std::string>& volumes = state.settings.volumes;
  choose_flow_volume(state.settings, *scene.info);
  if (!volume || volumes.empty()) return;
  ImGui::Checkbox("shown", &volume->shown);
  draw_values_at_probe(state, scene.volume_label, *volume);
  std::vector<std::string> beside(volumes.begin() + 1, volumes.end());
  draw_volume_look(state, scene, volumes.front(), scene.info->volumes, beside, seen_at_probe(state, *volume),
                   *volume, actions);
  volumes.resize(1);
  volumes.insert(volumes.end(), beside.begin(), beside.end());
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
