#include "common/window/panels/volume/lens_panel.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include <imgui.h>

#include "common/window/controls/lens_control.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {
namespace {

const char* kind_of(const ConvexShape& shape) {
  if (shape.quadric) return shape.half_spaces.empty() ? "sphere" : "cylinder";
  return shape.half_spaces.size() == 1 ? "half-space" : shape.half_spaces.size() == 6 ? "box" : "polyhedron";
}

/// How far a lens reaches from its middle along x; a half-space has no size.
std::optional<double> reach_of(const ConvexShape& shape) {
  if (!shape.quadric && shape.half_spaces.size() == 1) return std::nullopt;
  const LineInterval inside = clip_line(shape, center_of(shape, Vec3(0.0)), Vec3(1.0, 0.0, 0.0));
  return inside.last > 0.0 ? std::optional(inside.last) : std::nullopt;
}

enum class LensWish : std::uint8_t { kNone, kMove, kRemove };

/// Has the lens show what `appearance` does.
void take_appearance(Lens& lens, const Lens& appearance) {
  lens.transfer = appearance.transfer;
  lens.regions = appearance.regions;
  lens.colored = appearance.colored;
  lens.own_transfer = false;
}

/// Which field a lens shows, and whether by a transfer function of its own. An edit that would take more
/// transfer functions than a picture can have is taken back.
void edit_shown(VolumeView& view, std::size_t index, const std::vector<Late<Lens>>& appearances,
                const std::string& context, CachedHistogram& histograms) {
  const Lens before = view.lenses[index];
  Lens& lens = view.lenses[index];
  if (!view.fields.empty()) {
    const std::string now = lens.field == 0 ? context : view.fields[lens.field - 1].name;
    if (begin_combo("shows", now.c_str())) {
      for (std::size_t field = 0; field <= view.fields.size(); ++field) {
        const std::string& name = field == 0 ? context : view.fields[field - 1].name;
        if (!selectable(name.c_str(), lens.field == field) || field >= appearances.size()) continue;
        lens.field = field;
        take_appearance(lens, appearances[field].get());
      }
      ImGui::EndCombo();
    }
    hint("the scalar that is seen in the lens");
  }
  const Late<Lens>& appearance = appearances[std::min(lens.field, appearances.size() - 1)];
  const bool toggled = checkbox("own transfer function", &lens.own_transfer);
  hint("colours and opacities of this lens alone; else those of all lenses, below");
  if (toggled && !lens.own_transfer) take_appearance(lens, appearance.get());
  if (lens.own_transfer) {
    EditedTransfer own{lens.transfer.value_or(ColorTransfer()), lens.regions};
    if (choose_own_transfer("own", own, image_of(view, lens.field), histograms)) {
      lens.transfer = own.colors;
      lens.regions = own.regions;
    }
  }
  if (transfers_of(view).size() > kMostTransfers) lens = before;
}

void draw_lens_size(Lens& lens, const Box& bounds) {
  constexpr ImGuiSliderFlags kFlags = ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp;
  ImGui::SetNextItemWidth(ImGui::CalcItemWidth() - ImGui::GetTreeNodeToLabelSpacing());
  if (lens.screen) {
    slider_scalar("##size", ImGuiDataType_Double, &lens.screen->radius, &kSmallestCircle, &kLargestCircle,
                  "%.2f", kFlags);
    hint("radius, in halves of the picture's height");
    ImGui::SameLine();
  } else if (const auto reach = reach_of(lens.shape)) {
    constexpr double kLeast = 1e-3, kMost = 1.0;  // diagonals
    const double least = kLeast * bounds.diagonal(), most = kMost * bounds.diagonal();
    double wanted = *reach;
    const bool resized =
        slider_scalar("##size", ImGuiDataType_Double, &wanted, &least, &most, "%.4g", kFlags);
    hint("how far it reaches from its middle, in units of the data (wheel, while the mouse moves it)");
    if (resized) lens.shape = scaled(lens.shape, wanted / *reach);
    ImGui::SameLine();
  }
}

/// @param coarser what lies outside is of coarser voxels.
void draw_inside(Lens& lens, const Late<Lens>& model, bool coarser) {
  if (!lens.cut) {
    constexpr double kPlain = 1.0, kMostEnlarged = 8.0, kFewest = 0.5, kMost = 16.0;
    Lens enlarged = lens;
    enlarged.magnification = kMostEnlarged;
    if (magnifies(enlarged)) {
      slider_scalar("magnify", ImGuiDataType_Double, &lens.magnification, &kPlain, &kMostEnlarged, "%.1f x",
                    ImGuiSliderFlags_AlwaysClamp);
      hint("how many times larger it shows what is in it");
    }
    constexpr double kHard = 0.0, kSoft = 1.0;
    Lens blending = lens;
    blending.transition = kSoft;
    if (coarser && has_transition(blending)) {
      slider_scalar("blend", ImGuiDataType_Double, &lens.transition, &kHard, &kSoft, "%.2f",
                    ImGuiSliderFlags_AlwaysClamp);
      hint("share of the way to the middle in which the coarser values outside go over");
    }
    slider_scalar("samples", ImGuiDataType_Double, &lens.samples_per_voxel, &kFewest, &kMost, "%.1f",
                  ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    hint("samples a voxel along a ray, in the lens");
    checkbox("shading", &lens.shading);
    checkbox("silhouettes", &lens.illustrated);
    explain("illustration");
    hint("light on what is in the lens");
    ImGui::SameLine();
  }
  const bool toggled = checkbox("cut away", &lens.cut);
  hint("nothing is drawn in it: one sees what is behind");
  if (toggled && !lens.cut) {
    lens.field = 0;
    take_appearance(lens, model.get());
  }
}

/// @param unfolded at first; then, whether it is. @param coarser as draw_inside().
LensWish draw_lens(Lens& lens, const Late<Lens>& model, const Box& bounds, bool& unfolded, bool coarser) {
  unfolded = draw_fold(unfolded);
  if (unfolded) draw_lens_size(lens, bounds);
  ImGui::TextUnformatted(lens.screen ? "on the screen" : kind_of(lens.shape));
  if (unfolded) {
    draw_inside(lens, model, coarser);
  } else {
    ImGui::SameLine();
  }
  LensWish wish = LensWish::kNone;
  if (small_button("move")) wish = LensWish::kMove;
  hint("with the mouse; wheel: its size, Ctrl and wheel: along the view, click: leave it there");
  ImGui::SameLine();
  if (small_button("remove")) wish = LensWish::kRemove;
  hint("the lens (Ctrl+Z takes it back)");
  return wish;
}

}  // namespace

std::optional<std::size_t> draw_lens_panel(VolumeView& view, const std::vector<Late<Lens>>& appearances,
                                           const std::string& context, const Box& bounds,
                                           CachedHistogram& histograms) {
  const Late<Lens> model = appearances.empty() ? Late<Lens>() : appearances.front();
  std::optional<std::size_t> gone, taken;
  constexpr float kRows = 14.0F;
  const bool scrolls = begin_list("lenses", view.lenses.size(), kRows);
  for (std::size_t i = 0; i < view.lenses.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    bool unfolded = view.lenses.size() <= kShortList;
    const LensWish wish = draw_lens(view.lenses[i], model, bounds, unfolded, view.context.level > 0);
    if (wish == LensWish::kMove) taken = i;
    if (wish == LensWish::kRemove) gone = i;
    if (unfolded && !appearances.empty() && !view.lenses[i].cut && !view.lenses[i].colored)
      edit_shown(view, i, appearances, context, histograms);
    ImGui::PopID();
  }
  if (scrolls) ImGui::EndChild();
  if (gone) view.lenses.erase(view.lenses.begin() + static_cast<std::ptrdiff_t>(*gone));
  if (view.lenses.size() == kMostLenses) {
    ImGui::TextDisabled("%d lenses: no more are possible", static_cast<int>(kMostLenses));
    return taken;
  }
  const auto add = [&](Lens lens) {
    taken = view.lenses.size();
    view.lenses.push_back(std::move(lens));
  };
  const bool wanted = small_button("+ lens");
  hint("a ball that the mouse moves until it is clicked (L)");
  if (wanted) add(new_lens(model.get(), 0.5 * (bounds.lower + bounds.upper), bounds));
  ImGui::SameLine();
  if (view.lenses.size() < kMostLenses && small_button("+ on the screen")) add(new_screen_lens(model.get()));
  hint("a circle that stays where it is when the volume is turned; the mouse moves it until it is clicked");
  return taken;
}

}  // namespace palpate
