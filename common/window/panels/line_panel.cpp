#include "common/window/panels/line_panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "common/window/panels/panel_parts.h"
#include "common/window/panels/time_panel.h"

namespace palpate {
namespace {

/// @param speed whether the field has one.
void draw_seeds(PanelState& state, bool speed) {
  static const std::vector<std::string> kKinds{"grid", "random", "speed", "other"};
  static const std::vector<std::string> kWithoutSpeed{"grid", "random", "other"};
  std::string kind = kKinds[static_cast<std::size_t>(state.seeds.kind)];
  if (choose_word("seeds", kind, speed ? kKinds : kWithoutSpeed)) {
    // `other` starts from the text of what was chosen before.
    state.seeds.text = seeds_text(state.seeds);
    state.seeds.kind =
        static_cast<SeedChoice::Kind>(std::find(kKinds.begin(), kKinds.end(), kind) - kKinds.begin());
  }
  constexpr int kMost = 1'000'000, kMostAcross = 200;
  switch (state.seeds.kind) {
    case SeedChoice::Kind::kGrid:
      ImGui::DragInt3("along x y z", state.seeds.grid.data(), 0.1F, 1, kMostAcross, "%d",
                      ImGuiSliderFlags_AlwaysClamp);
      break;
    case SeedChoice::Kind::kRandom:
    case SeedChoice::Kind::kSpeed:
      ImGui::DragInt("number", &state.seeds.count, 2.0F, 1, kMost, "%d",
                     ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic);
      break;
    case SeedChoice::Kind::kText:
      // Half a word is no seeds: taken when it is complete.
      ImGui::InputText("as --seeds", &state.seeds.text);
      if (ImGui::IsItemActive()) return;
      break;
  }
  state.settings.seeds = seeds_text(state.seeds);
}

/// The plane across the middle of `bounds` whose nearer side is left out.
ConvexShape::HalfSpace facing(const Camera& camera, const Box& bounds) {
  return {camera.axes[2], glm::dot(camera.axes[2], 0.5 * (bounds.lower + bounds.upper))};
}

/// Where it is cut, whether it is turned to the viewer anew, and how deep.
void draw_cut(std::optional<ConvexShape::HalfSpace>& cut, const Box& bounds, const Camera& camera) {
  bool on = cut.has_value();
  if (ImGui::Checkbox("cut away", &on)) {
    cut.reset();
    if (on) cut = facing(camera, bounds);
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("what lies before a plane is left out of the picture");
  if (!cut) return;
  ImGui::SameLine();
  if (ImGui::SmallButton("face me")) cut = facing(camera, bounds);
  // All of the box lies between these.
  const double middle = glm::dot(cut->outward, 0.5 * (bounds.lower + bounds.upper));
  const double reach = 0.5 * glm::dot(glm::abs(cut->outward), bounds.upper - bounds.lower);
  (void)slider("cut at", cut->offset, middle - reach, middle + reach, "%.4g");
}

}  // namespace

void draw_lines(PanelState& state, const SceneState& scene) {
  section("LINES");
  SceneSettings& settings = state.settings;
  const SceneInfo& info = *scene.info;
  choose_word("field", settings.field, info.fields);
  draw_time(state, info.times);
  draw_seeds(state, true);
  static const std::vector<std::string> kDirections{"forward", "backward", "both"};
  choose_word("direction", settings.direction, kDirections);
  choose_word("integrator", settings.integrator, info.integrators);
  const double diagonal = info.bounds.diagonal();
  constexpr double kDefaultStep = 1e-3, kDefaultLength = 10.0;  // diagonals
  if (settings.integrator == "euler" || settings.integrator == "rk4") {
    constexpr int kFinest = -6, kCoarsest = -1;
    double step = diagonal > 0.0 && settings.step > 0.0 ? settings.step / diagonal : kDefaultStep;
    if (decade_slider("step / diagonal", step, kFinest, kCoarsest)) settings.step = step * diagonal;
  } else {
    constexpr int kTightest = -12, kLoosest = -2;
    decade_slider("tolerance", settings.tolerance, kTightest, kLoosest);
  }
  if (diagonal > 0.0) {
    constexpr double kShortest = 0.01, kLongest = 100.0;
    double length = settings.max_length > 0.0 ? settings.max_length / diagonal : kDefaultLength;
    if (ImGui::SliderScalar("max length", ImGuiDataType_Double, &length, &kShortest, &kLongest,
                            "%.2f diagonals", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp)) {
      settings.max_length = length * diagonal;
    }
  }
}

void draw_layer(PanelState& state, const SceneState& scene, const Camera& camera) {
  section("LAYER");
  SceneSettings& settings = state.settings;
  const SceneInfo& info = *scene.info;
  choose_word("field", settings.field, info.fields);
  draw_time(state, info.times);
  (void)slider("depth", settings.layer, info.layers->lower, info.layers->upper, "%.2f");
  draw_seeds(state, false);
  draw_cut(settings.cut, info.bounds, camera);
  choose_plotted(state, info);
  double spacing = settings.contours;
  if (ImGui::InputDouble("contour spacing", &spacing, 0.0, 0.0, "%.4g",
                         ImGuiInputTextFlags_EnterReturnsTrue) &&
      std::isfinite(spacing)) {
    settings.contours = std::max(spacing, 0.0);
  }
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("lines where what colours the layer is a multiple of this: isochrones; 0: none");
  const char* kNothing = "nothing";
  if (ImGui::BeginCombo("inside lens (L)",
                        settings.lens_array.empty() ? kNothing : settings.lens_array.c_str())) {
    if (ImGui::Selectable(kNothing, settings.lens_array.empty())) settings.lens_array.clear();
    for (const std::string& name : info.color_arrays)
      if (ImGui::Selectable(name.c_str(), name == settings.lens_array)) settings.lens_array = name;
    ImGui::EndCombo();
  }
}

void draw_color(PanelState& state, const SceneState& scene, SceneView& view) {
  section("COLOUR");
  LineStyle& style = view.style;
  std::string& array = state.settings.color_array;
  const std::string now = array.empty() ? std::string(name_of(style.color_by)) : array;
  if (ImGui::BeginCombo("by", now.c_str())) {
    const auto list_quantities = [&] {
      for (int i = 0; i < kColorByCount; ++i) {
        const auto by = static_cast<ColorBy>(i);
        if (by == ColorBy::kArray) continue;
        if (ImGui::Selectable(std::string(name_of(by)).c_str(), array.empty() && by == style.color_by)) {
          style.color_by = by;
          style.range.reset();
          style.logarithmic.reset();
          array.clear();
        }
      }
    };
    // These have to be sampled first: the colours follow when that is done.
    const auto list_arrays = [&] {
      for (const std::string& name : scene.info->color_arrays) {
        if (ImGui::Selectable(name.c_str(), name == array)) array = name;
      }
    };
    // A heart is looked at for what its muscle does, a flow for its lines.
    if (scene.info->layers) {
      list_arrays();
      ImGui::Separator();
      list_quantities();
    } else {
      list_quantities();
      list_arrays();
    }
    ImGui::EndCombo();
  }
  const bool mapped = style.color_by != ColorBy::kDirection && style.color_by != ColorBy::kTermination &&
                      style.color_by != ColorBy::kUniform;
  if (!mapped) return;
  const ColorMap map = color_map_of(style);
  if (ImGui::BeginCombo("map", std::string(name_of(map)).c_str())) {
    for (const ColorMap choice : {ColorMap::kSequential, ColorMap::kHeat, ColorMap::kDiverging}) {
      if (ImGui::Selectable(std::string(name_of(choice)).c_str(), choice == map)) style.color_map = choice;
    }
    ImGui::EndCombo();
  }
  bool automatic = !style.range.has_value();
  if (ImGui::Checkbox("automatic range", &automatic)) {
    style.range =
        automatic ? std::nullopt : std::optional(state.picture.automatic_range.value_or(ValueRange{}));
  }
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("of the usual values; of a scalar that changes in time the same at all its steps");
  if (style.range) {
    ValueRange range = *style.range;
    std::array<double, 2> ends{range.lower, range.upper};
    if (ImGui::InputScalarN("range", ImGuiDataType_Double, ends.data(), 2, nullptr, nullptr, "%.4g") &&
        ends[0] < ends[1]) {
      style.range = ValueRange{ends[0], ends[1]};
    }
  }
  if (style.color_by != ColorBy::kSeed) {
    bool logarithmic = is_logarithmic(style);
    if (ImGui::Checkbox("logarithmic", &logarithmic)) style.logarithmic = logarithmic;
  }
}

}  // namespace palpate
