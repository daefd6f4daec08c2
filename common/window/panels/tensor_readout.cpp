#include "common/window/panels/tensor_readout.h"

#include <imgui.h>

#include "common/field/tensor/diffusion_measures.h"
#include "common/math/symmetric3.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {

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
