#include "common/window/panels/volume/curve_panel.h"

#include <algorithm>
#include <array>
#include <string>

#include <imgui.h>

#include "common/base/index.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/window/panels/panel_parts.h"
#include "common/window/panels/volume/curve_editor.h"

namespace palpate {
namespace {

constexpr double kFarthest = 0.020;  // [m] of a threshold, to begin with

constexpr bool needs_flow(AxisRule) noexcept { return false; }

/// A drop-down of the values of an enumeration that count from `first`. @return whether another was chosen.
template <typename Enum>
bool choose(const char* label, Enum& value, int count, bool has_flow) {
  bool changed = false;
  if (!begin_combo(label, std::string(name_of(value)).c_str())) return false;
  for (int i = 0; i < count; ++i) {
    const auto each = static_cast<Enum>(i);
    if (!has_flow && needs_flow(each)) continue;
    if (!selectable(std::string(name_of(each)).c_str(), each == value)) continue;
    changed = !(each == value);
    value = each;
  }
  ImGui::EndCombo();
  return changed;
}

/// Which of the curves of an axis is shown.
struct ShownCurve {
  std::size_t axis = 0;
  bool kappa = false;
};

ShownCurve choose_curve(const LinearSettings& settings) {
  int& stored = *ImGui::GetStateStorage()->GetIntRef(ImGui::GetID("shown curve"), 0);
  const int axes = leaves_axes_open(settings.reference) ? 2 : 3;
  const auto label = [axes](int i) {
    const std::string axis = axes == 2 && i / 2 == 1 ? "2, 3" : std::to_string(i / 2 + 1);
    return std::string(i % 2 == 0 ? "threshold of axis " : "stiffness of axis ") + axis;
  };
  stored = std::clamp(stored, 0, 2 * axes - 1);
  if (begin_combo("curve", label(stored).c_str())) {
    for (int i = 0; i < 2 * axes; ++i) {
      if (selectable(label(i).c_str(), i == stored)) stored = i;
    }
    ImGui::EndCombo();
  }
  return {as_size(stored / 2), stored % 2 == 1};
}

void edit_linear(LinearSettings& settings, const ProbeSession& session) {
  const bool has_flow = session.data().has_flow();
  if (choose("directions", settings.reference, kLinearReferenceCount, has_flow) &&
      leaves_axes_open(settings.reference)) {
    settings.axes[2] = settings.axes[1];
  }
  const bool open = leaves_axes_open(settings.reference);
  constexpr std::array<const char*, 3> kAxes{"axis 1", "axis 2", "axis 3"};
  for (std::size_t a = 0; a < (open ? 2U : 3U); ++a) {
    choose(open && a == 1 ? "axes 2, 3" : kAxes[a], settings.axes[a].rule, kAxisRuleCount, true);
  }
  choose("measure", settings.measure, kLinearMeasureCount, has_flow);
  const ShownCurve shown = choose_curve(settings);
  LinearAxis& axis = settings.axes[shown.axis];
  const auto [lowest, highest] = session.data().measure_range(settings.measure);
  CurveRange range{.low_measure = lowest, .high_measure = highest};
  const std::string measure(name_of(settings.measure));
  const ScalarStatistics* const statistics =
      settings.measure == LinearMeasure::kSpeed ? nullptr : session.data().statistics();
  const ValueHistogram* const histogram = statistics == nullptr ? nullptr
                                          : settings.measure == LinearMeasure::kGradient
                                              ? &statistics->gradients
                                              : &statistics->values;
  if (shown.kappa) {
    draw_curve_editor({.name = "kappa", .measure = measure}, range, axis.kappa, histogram);
  } else {
    range.high_value = kFarthest;
    draw_curve_editor({.name = "tau", .measure = measure, .unit = "mm", .units = kMillimetres}, range,
                      axis.tau, histogram);
  }
  if (open) settings.axes[2] = settings.axes[1];
  edit_setting("friction", settings.friction);
}

void edit_anisotropy(AnisotropySettings& settings) {
  AnisotropySettings edited = settings;
  const CurveRange range{.high_value = kFarthest};
  if (!draw_curve_editor({.name = "tau", .measure = "anisotropy", .unit = "mm", .units = kMillimetres}, range,
                         edited.tau)) {
    return;
  }
  // The chain takes only curves that begin at nothing and never fall: other moves of a knot are not made.
  if (edited.valid()) settings = edited;
}

}  // namespace

void edit_texture(TextureSettings& settings, const HapticMode& mode, const ProbeSession& session) {
  // Noise of an image hardly exceeds a tenth of the range of its values.
  constexpr double kMostNoise = 0.1, kCoarsest = 0.005;
  if (!mode.texture || !session.data().scalar() || session.data().has_flow()) return;
  checkbox("noise as a texture", &settings.by_noise);
  explain("noise-texture");
  if (session.measures_noise()) {
    ImGui::SameLine();
    ImGui::TextDisabled("measuring");
  }
  if (!settings.by_noise) return;
  draw_curve_editor({.name = "grain", .measure = "noise", .unit = "mm", .units = kMillimetres},
                    {.high_measure = kMostNoise, .high_value = kCoarsest}, settings.grain);
}

void edit_curves(TouchChoice& choice, std::string_view mode, const ProbeSession& session) {
  if (mode == kLinearMode) edit_linear(choice.settings.linear, session);
  if (session.data().has_tensors()) edit_anisotropy(choice.settings.anisotropy);
  if (mode == kDensityMode) {
    draw_curve_editor({.name = "density", .measure = "value"}, {}, choice.settings.force_field.density);
  }
}

}  // namespace palpate
