#include "common/window/panels/tensor_panel.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <string>

#include <imgui.h>

#include "common/base/text.h"
#include "common/field/tensor/diffusion_measures.h"
#include "common/math/symmetric3.h"
#include "common/window/panels/readout_rows.h"

namespace palpate {
namespace {

// A drop-down of an enumeration with `count` members.
template <typename Enum>
void choose(const char* label, Enum& chosen, int count) {
  if (!ImGui::BeginCombo(label, std::string(name_of(chosen)).c_str())) return;
  for (int i = 0; i < count; ++i) {
    const auto member = static_cast<Enum>(i);
    if (ImGui::Selectable(std::string(name_of(member)).c_str(), member == chosen)) chosen = member;
  }
  ImGui::EndCombo();
}

// Where the slice across axis 0, 1 or 2 of the data lies, voxel by voxel.
void draw_slice(TensorView& view, std::size_t axis, const char* name) {
  const TensorVoxels& voxels = *view.image;
  const int own = slice_axes(voxels.axes)[axis];
  ImGui::PushID(static_cast<int>(axis));
  ImGui::Checkbox("##shown", &view.slices[static_cast<std::size_t>(own)]);
  ImGui::SameLine();
  const int last = voxels.points[own] - 1;
  // Sliders rise with the data's coordinate, whichever way the voxels are counted.
  const bool forwards = voxels.axes[own][static_cast<int>(axis)] > 0.0;
  const int now = static_cast<int>(std::lround(voxels.grid_coordinates(view.position)[own]));
  int place = forwards ? now : last - now;
  const std::string text = short_number(std::round(10.0 * view.position[static_cast<int>(axis)]) / 10.0);
  if (ImGui::SliderInt(name, &place, 0, last, text.c_str(), ImGuiSliderFlags_AlwaysClamp)) {
    const int wanted = forwards ? place : last - place;
    view.position = moved_position(voxels, view.position, own, wanted - now);
  }
  ImGui::PopID();
}

}  // namespace

void draw_tensor_panel(TensorView& view, bool anatomical) {
  static constexpr std::array<const char*, 3> kPatient{"sagittal", "coronal", "axial"};
  static constexpr std::array<const char*, 3> kPlain{"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) draw_slice(view, axis, (anatomical ? kPatient : kPlain)[axis]);
  ImGui::Checkbox("crosshair", &view.crosshair);
  ImGui::SameLine(0.5F * ImGui::GetContentRegionAvail().x);
  ImGui::Checkbox("smooth", &view.smooth);
  if (!view.image->field) return;  // a lattice alone
  choose("colour", view.color, kTensorColorCount);
  choose("glyphs", view.glyphs, kGlyphShapeCount);
  if (view.glyphs == GlyphShape::kNone) return;
  constexpr double kLeast = 0.0, kMost = 1.0, kClose = 8.0, kFar = 100.0;
  ImGui::SliderScalar("from FA", ImGuiDataType_Double, &view.glyph_least_fa, &kLeast, &kMost, "%.2f",
                      ImGuiSliderFlags_AlwaysClamp);
  ImGui::SliderScalar("spacing", ImGuiDataType_Double, &view.glyph_spacing, &kClose, &kFar, "%.0f",
                      ImGuiSliderFlags_AlwaysClamp);
}

bool draw_underlay_panel(TensorView& view, const std::string& file) {
  if (!view.underlay) {
    ImGui::TextDisabled("none: drop an image on the window");
    return false;
  }
  UnderlayView& underlay = *view.underlay;
  ImGui::TextWrapped("%s", std::filesystem::path(file).filename().string().c_str());
  const double span = underlay.image->highest - underlay.image->lowest;
  if (span > 0.0) {
    constexpr double kNarrowest = 1e-3, kWidest = 2.0;  // of the values
    const double narrow = kNarrowest * span, wide = kWidest * span;
    ImGui::SliderScalar("window", ImGuiDataType_Double, &underlay.window.width, &narrow, &wide, "%.4g",
                        ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    ImGui::SliderScalar("level", ImGuiDataType_Double, &underlay.window.level, &underlay.image->lowest,
                        &underlay.image->highest, "%.4g", ImGuiSliderFlags_AlwaysClamp);
  }
  if (!view.image->field) return false;  // there is nothing to blend with, and no slice without it
  choose("colours over it", underlay.blend, kUnderlayBlendCount);
  return ImGui::Button("Remove underlay");
}

void add_tensor_rows(const Mat3& tensor, ReadoutRows& rows) {
  const SymmetricEigen eigen = symmetric_eigen(tensor);
  const Anisotropy shares = anisotropy(eigen.values);
  const Vec3& e1 = eigen.vectors[0];
  rows.add("FA", "%.3f", fractional_anisotropy(eigen.values));
  rows.add("MD", "%.4g", mean_diffusivity(eigen.values));
  rows.add("cl cp cs", "%.3f  %.3f  %.3f", shares.linear, shares.planar, shares.spherical);
  rows.add("e1", "%.3f  %.3f  %.3f", e1.x, e1.y, e1.z);
  if (has_negative(eigen.values)) rows.add("", "an eigenvalue is below zero");
}

void add_fibre_rows(const Mat3& fibres, ReadoutRows& rows) {
  const SymmetricEigen eigen = symmetric_eigen(fibres);
  const Vec3& direction = eigen.vectors[0];
  rows.add("fibre", "%.3f  %.3f  %.3f", direction.x, direction.y, direction.z);
  rows.add("gap", "%.3f", anisotropy(eigen.values).linear);
}

float draw_tensor_readout(const TensorPick& pick, float left, float top) {
  ImGui::SetNextWindowPos({left, top});
  ImGui::SetNextWindowBgAlpha(0.7F);
  constexpr ImGuiWindowFlags kFlags =
      ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
      ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs;
  ImGui::Begin("voxel", nullptr, kFlags);
  ReadoutRows rows("voxel");
  rows.add("voxel", "%d  %d  %d", pick.voxel.x, pick.voxel.y, pick.voxel.z);
  rows.add("at", "%.4g  %.4g  %.4g", pick.position.x, pick.position.y, pick.position.z);
  if (pick.tensor) add_tensor_rows(*pick.tensor, rows);
  if (pick.underlay) rows.add("underlay", "%.5g", *pick.underlay);
  rows.finish();
  const float height = ImGui::GetWindowHeight();
  ImGui::End();
  return height;
}

}  // namespace palpate
