#include "common/window/panels/tract_panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <imgui.h>

#include "common/base/text.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {
namespace {

constexpr int kMostSeedsPerVoxel = 64;

/// The shortest edge of a voxel [data units].
double shortest_edge(const TensorVoxels& voxels) {
  const Mat3& a = voxels.axes;
  return std::min({glm::length(a[0]), glm::length(a[1]), glm::length(a[2])});
}

double radius_of(const TractSeedChoice& choice, const TensorVoxels& voxels) {
  constexpr double kVoxels = 3.0;
  return choice.radius.value_or(kVoxels * shortest_edge(voxels));
}

}  // namespace

std::string tract_seed_words(const TractSeedChoice& choice, const TensorView& tensors) {
  if (!choice.at_crosshair) return "fa:" + short_number(choice.least_fa);
  const Vec3& x = tensors.position;
  return "sphere:" + short_number(x.x) + "," + short_number(x.y) + "," + short_number(x.z) + "," +
         short_number(radius_of(choice, *tensors.image));
}

void draw_tract_panel(TractSeedChoice& choice, SceneSettings& settings, const TensorView& tensors,
                      std::optional<TractView>& look) {
  constexpr std::array<const char*, 2> kWhere{"a ball at the crosshair", "all of high FA"};
  int where = choice.at_crosshair ? 0 : 1;
  if (ImGui::Combo("start in", &where, kWhere.data(), static_cast<int>(kWhere.size())))
    choice.at_crosshair = where == 0;
  if (choice.at_crosshair) {
    constexpr double kLeast = 0.5, kMost = 30.0;  // voxels
    const double edge = shortest_edge(*tensors.image);
    double radius = radius_of(choice, *tensors.image);
    if (slider("radius", radius, kLeast * edge, kMost * edge, "%.3g", ImGuiSliderFlags_Logarithmic))
      choice.radius = radius;
  } else {
    slider("FA above", choice.least_fa, 0.0, 1.0, "%.2f");
  }
  // Tracts that are shown are traced again with these.
  ImGui::SliderInt("per voxel", &settings.seeds_per_voxel, 1, kMostSeedsPerVoxel, "%d",
                   ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  slider("end at FA", settings.cutoff, 0.0, 1.0, "%.2f");
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 size{0.5F * (ImGui::GetContentRegionAvail().x - gap), 0.0F};
  if (ImGui::Button("Trace", size)) {
    settings.seeds = tract_seed_words(choice, tensors);
    settings.tracts.clear();
  }
  ImGui::SameLine();
  if (ImGui::Button("Remove", size)) {
    settings.seeds.clear();
    settings.tracts.clear();
  }
  // Always there, so that nothing below moves when tracts come and go.
  TractView none;
  ImGui::BeginDisabled(!look);
  draw_tract_look(look ? *look : none);
  ImGui::EndDisabled();
}

void draw_tract_look(TractView& look) {
  constexpr double kThin = 0.5, kThick = 20.0, kFaint = 0.05, kFull = 1.0;
  slider("width", look.width, kThin, kThick, "%.1f", ImGuiSliderFlags_Logarithmic);
  slider("opacity", look.opacity, kFaint, kFull, "%.2f");
}

}  // namespace palpate
