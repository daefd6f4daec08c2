#include "common/window/panels/panes_panel.h"

#include <array>
#include <string>
#include <vector>

#include <imgui.h>

#include "common/base/index.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {
namespace {

/// Slices show grey values, which the volume beside them may not have.
void begin_window(VolumeView& volume, const ValueHistogram* histogram) {
  if (!volume.slice_images.empty()) return;
  if (!volume.planes.window && histogram != nullptr) volume.planes.window = default_window(*histogram);
}

/// What slices show, of what there is, and its grey values.
void edit_slice_image(VolumeView& volume) {
  std::vector<std::string> names;
  for (const SliceImage& one : volume.slice_images) names.push_back(one.name);
  if (choose_word("slices show", volume.panes.shown, names)) volume.panes.window.reset();
  explain("slice-show", false);
  const SliceImage shown = shown_in_slices(volume);
  const double lower = shown.image->lowest, upper = shown.image->highest, range = upper - lower;
  if (!(range > 0.0)) return;
  constexpr double kNarrowest = 1e-4;
  const double least = kNarrowest * range, most = 2.0 * range;
  ValueWindow window = shown.window;
  bool edited = slider_scalar("slice window", ImGuiDataType_Double, &window.width, &least, &most, "%.5g");
  explain("slice-window", false);
  edited |= slider_scalar("slice level", ImGuiDataType_Double, &window.level, &lower, &upper, "%.5g");
  explain("slice-level", false);
  if (edited && window.width > 0.0) volume.panes.window = window;
}

template <typename Names, typename Enum>
void edit_word(const char* setting_name, const Names& names, Enum& value) {
  std::string word(names[as_size(value)]);
  if (!edit_setting(setting_name, word)) return;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == word) value = static_cast<Enum>(i);
  }
}

}  // namespace

void next_layout(VolumeView& volume, const ValueHistogram* histogram) {
  volume.panes.layout = volume.panes.layout == 1 ? 2 : volume.panes.layout == 2 ? 4 : 1;
  begin_window(volume, histogram);
}

void edit_panes(VolumeView& volume, const ValueHistogram* histogram, bool anatomical) {
  SlicePanes& panes = volume.panes;
  if (!section("SLICES")) return;
  std::string layout = std::to_string(panes.layout);
  if (edit_setting("layout", layout)) {
    panes.layout = layout == "4" ? 4 : layout == "2" ? 2 : 1;
    begin_window(volume, histogram);
  }
  if (panes.layout == 1) return;
  if (panes.layout == 2) edit_word("pane", kSlicePlaneNames, panes.first);
  if (volume.slice_images.empty()) {
    edit_window(volume);
  } else {
    edit_slice_image(volume);
  }
  std::array<double, 3> cross{panes.cross.x, panes.cross.y, panes.cross.z};
  input_numbers("crosshair at", cross.data(), 3, "%.6g");
  explain("cross");
  if (ImGui::IsItemDeactivatedAfterEdit()) {
    const Box bounds = volume.image->bounds();
    panes.cross = glm::clamp(Vec3(cross[0], cross[1], cross[2]), bounds.lower, bounds.upper);
  }
  const double none = 0.0, most = 0.25 * volume.image->bounds().diagonal();
  slider_scalar("slab", ImGuiDataType_Double, &panes.slab, &none, &most, "%.4g",
                ImGuiSliderFlags_AlwaysClamp);
  explain("slab");
  if (panes.slab > 0.0) edit_word("slab-rule", kSlabRuleNames, panes.rule);
  if (!volume.fields.empty()) edit_setting("slice-blend", panes.blend);
  if (anatomical) {
    constexpr std::array<const char*, 2> kSides{"neurological", "radiological"};
    std::string side = kSides[as_size(panes.radiological ? 1 : 0)];
    if (edit_setting("slice-side", side)) panes.radiological = side == kSides[1];
  }
  if (small_button("reset slices")) {
    const SlicePanes usual;
    const Vec3 middle = volume.image->bounds().center();
    panes.turn = usual.turn;
    panes.zoom = usual.zoom;
    panes.center = panes.cross = middle;
  }
  hint("through the middle, along the axes of the data, all of the volume seen");
}

void edit_window(VolumeView& volume) {
  const double lower = volume.image->lowest, upper = volume.image->highest, range = upper - lower;
  if (!(range > 0.0)) return;
  constexpr double kNarrowest = 1e-4;
  const double least = kNarrowest * range, most = 2.0 * range;
  ValueWindow window = window_of(volume);
  bool edited = slider_scalar("window", ImGuiDataType_Double, &window.width, &least, &most, "%.5g");
  explain("window");
  edited |= slider_scalar("level", ImGuiDataType_Double, &window.level, &lower, &upper, "%.5g");
  explain("level");
  if (edited && window.width > 0.0) volume.planes.window = window;
}

}  // namespace palpate
