#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <imgui.h>

#include "apps/cardiac/cardiac_model.h"
#include "apps/cardiac/cut_away.h"
#include "apps/cardiac/heart_scene.h"
#include "apps/cardiac/surface_brush.h"
#include "common/base/text.h"
#include "common/field/heart/regions.h"
#include "common/math/vec_text.h"
#include "common/window/controls/color_lens_control.h"
#include "common/window/files/folder_list.h"
#include "common/window/panels/color_panel.h"
#include "common/window/panels/panel_parts.h"
#include "common/window/panels/seed_panel.h"
#include "common/window/panels/time_panel.h"

namespace palpate {
namespace {

/// The plane across the middle of `bounds` whose nearer side is left out.
CutPlane facing(const Camera& camera, const Box& bounds) {
  return {camera.axes[2], glm::dot(camera.axes[2], 0.5 * (bounds.lower + bounds.upper))};
}

/// Where it is cut, whether it is turned to the viewer again, and how deep.
void draw_cut(std::string& text, const Box& bounds, const Camera& camera) {
  std::optional<CutPlane> cut = parse_cut(text);
  bool on = cut.has_value();
  if (checkbox("cut away", &on)) {
    cut.reset();
    if (on) cut = facing(camera, bounds);
  }
  hint("what lies before a plane is left out of the picture");
  if (cut) {
    ImGui::SameLine();
    if (small_button("face me")) cut = facing(camera, bounds);
    hint("turns the cut to the viewer");
    // All of the box lies between these.
    const double middle = glm::dot(cut->normal, 0.5 * (bounds.lower + bounds.upper));
    const double reach = 0.5 * glm::dot(glm::abs(cut->normal), bounds.upper - bounds.lower);
    (void)slider("cut at", cut->distance, middle - reach, middle + reach, "%.4g");
    explain("cut");
  }
  text = cut ? exact_text(cut->normal) + "," + exact_number(cut->distance) : std::string();
}

/// What the layer shows inside a lens.
void choose_lens(HeartOptions& heart, const SceneInfo& info, const SceneView& view) {
  constexpr const char* kNothing = "nothing";
  if (!begin_combo("inside lens (L)", heart.lens.empty() ? kNothing : heart.lens_angle.c_str())) return;
  if (selectable(kNothing, heart.lens.empty())) heart.lens.clear();
  for (const std::string& name : info.color_arrays) {
    if (!selectable(name.c_str(), !heart.lens.empty() && name == heart.lens_angle)) continue;
    heart.lens_angle = name;
    if (heart.lens.empty()) add_color_lens(view, heart);
  }
  ImGui::EndCombo();
}

/// Which layer is shown, where its fibres start, and where it is cut away: facing the view.
void draw_layer(PanelContext& on) {
  const bool layered = on.scene.info->layers.has_value();
  if (!section(layered ? "LAYER" : "SURFACE")) return;
  HeartOptions& heart = on.state.document.heart;
  const SceneInfo& info = *on.scene.info;
  choose_word("field", on.state.document.input.field, info.fields);
  explain("field", false);
  draw_time(on.state, info.times);
  if (layered) {
    double depth = layer_of(heart).value_or(kViewLayer);
    if (slider("depth", depth, info.layers->lower, info.layers->upper, "%.2f"))
      heart.layer = exact_number(depth);
    explain("layer");
    draw_seeds(on.state, false);
  }
  draw_cut(heart.cut, info.bounds, on.view.camera);
  choose_plotted(on.state, info);
  double spacing = heart.contours;
  if (input_numbers("contour spacing", &spacing, 1, "%.4g", ImGuiInputTextFlags_EnterReturnsTrue) &&
      std::isfinite(spacing)) {
    heart.contours = std::max(spacing, 0.0);
  }
  explain("contour-spacing");
  if (layered) choose_lens(heart, info, on.view);
}

/// Another heart or result at the right.
class BesidePanel {
 public:
  void operator()(PanelContext& on) {
    HeartOptions& heart = on.state.document.heart;
    if (!section("COMPARE", heart.beside.empty() && heart.beside_angle.empty(), {"compare", "compare-angle"}))
      return;
    if (!typing_) typed_ = heart.beside.string();
    (void)input_text("other heart", &typed_);
    if (ImGui::IsItemDeactivatedAfterEdit()) heart.beside = typed_;
    typing_ = ImGui::IsItemActive();
    explain("compare");
    choose_from_folder(on.state.document.input.files, heart.beside);
    constexpr const char* kSame = "as this one";
    if (begin_combo("its colour", heart.beside_angle.empty() ? kSame : heart.beside_angle.c_str())) {
      if (selectable(kSame, heart.beside_angle.empty())) heart.beside_angle.clear();
      for (const std::string& name : on.scene.info->color_arrays) {
        if (selectable(name.c_str(), name == heart.beside_angle)) heart.beside_angle = name;
      }
      ImGui::EndCombo();
    }
    explain("compare-angle");
    if (has_two_eyes(on.view) && on.view.beside)
      ImGui::TextWrapped("In stereo the heart at the left is shown alone.");
  }

 private:
  /// For those who have only a mouse: hearts and results beside the first file, listed when they are asked for.
  void choose_from_folder(const std::vector<std::filesystem::path>& files, std::filesystem::path& chosen) {
    if (files.empty()) return;
    const bool opened = begin_combo("from its folder", chosen.empty() ? "none" : chosen.filename().c_str());
    if (opened && !listed_) {
      const auto shows = [](const std::filesystem::path& path, bool folder) {
        const std::string ending = path.extension().string();
        return !folder && ending != ".toml" &&
               (ending == ".igb" || ending == ".dat" || can_open(path, folder, FieldKind::kFibre));
      };
      const std::filesystem::path parent = files.front().parent_path();
      entries_ = list_folder(parent.empty() ? "." : parent, shows, false).entries;
    }
    listed_ = opened;
    if (!opened) return;
    if (selectable("none", chosen.empty())) chosen.clear();
    for (const FolderEntry& entry : entries_) {
      const std::filesystem::path file = files.front().parent_path() / entry.name;
      if (!entry.folder && selectable(entry.name.c_str(), file == chosen)) chosen = file;
    }
    ImGui::EndCombo();
  }

  std::string typed_;
  bool typing_ = false, listed_ = false;
  std::vector<FolderEntry> entries_;
};

/// Which regions are taken: as boxes to tick, the last of which stays. Those without fibres cannot be.
void draw_regions(PanelContext& on) {
  const std::vector<RegionCount>& regions = on.scene.info->regions;
  if (regions.size() < 2 || !section("REGIONS")) return;
  std::string& text = on.state.document.input.regions;
  std::vector<double> chosen = parse_regions(text);
  const auto taken = [&chosen](double number) { return std::ranges::find(chosen, number) != chosen.end(); };
  const bool all = chosen.empty();
  const auto can_be = std::ranges::count(regions, false, &RegionCount::left_out);
  const bool scrolls = begin_list("##regions", regions.size(), 6.0F);
  for (const auto& [number, elements, left_out] : regions) {
    bool on_now = !left_out && (all || taken(number));
    const std::string label = "region " + exact_number(number) + (left_out ? ", no fibres" : "");
    ImGui::BeginDisabled(left_out);
    if (checkbox(label.c_str(), &on_now)) {
      if (all)
        for (const RegionCount& each : regions)
          if (!each.left_out) chosen.push_back(each.number);
      std::erase(chosen, number);
      if (on_now) chosen.push_back(number);
      if (!chosen.empty()) text = std::ssize(chosen) == can_be ? std::string() : regions_text(chosen);
    }
    ImGui::EndDisabled();
    hint("%s", counted(elements, "element").c_str());
  }
  if (scrolls) ImGui::EndChild();
  if (small_button("all that have fibres")) text.clear();
  explain("regions");
}

}  // namespace

std::vector<PanelPart> cardiac_panels() {
  return {draw_layer, SurfaceBrush(), draw_regions, draw_layer_colors, BesidePanel()};
}

}  // namespace palpate
