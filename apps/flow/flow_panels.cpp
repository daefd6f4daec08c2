#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <imgui.h>

#include "apps/flow/flow_model.h"
#include "common/base/text.h"
#include "common/compose/trace_options.h"
#include "common/trace/unsteady/trace_unsteady.h"
#include "common/window/panels/color_panel.h"
#include "common/window/panels/panel_parts.h"
#include "common/window/panels/seed_panel.h"
#include "common/window/panels/time_panel.h"
#include "common/window/panels/volume/volume_panel.h"

namespace palpate {
namespace {

void draw_lines(PanelState& state, const SceneState& scene) {
  if (!section("LINES")) return;
  TracingOptions& settings = state.document.tracing;
  const SceneInfo& info = *scene.info;
  choose_word("field", state.document.input.field, info.fields);
  explain("field", false);
  draw_time(state, info.times);
  if (info.times.size() > 1) edit_setting("lines", settings.lines);
  if (settings.lines != name_of(LineKind::kStreamlines)) edit_setting("time-order", settings.time_order);
  draw_seeds(state, true);
  edit_setting("direction", settings.direction);
  choose_word("integrator", settings.integrator, info.integrators);
  explain("integrator");
  const double diagonal = info.bounds.diagonal();
  constexpr double kDefaultStep = 1e-3, kDefaultLength = 10.0;  // diagonals
  if (settings.integrator == "euler" || settings.integrator == "rk4") {
    constexpr int kFinest = -6, kCoarsest = -1;
    double step = diagonal > 0.0 && settings.step > 0.0 ? settings.step / diagonal : kDefaultStep;
    if (decade_slider("step / diagonal", step, kFinest, kCoarsest)) settings.step = step * diagonal;
    explain("step");
  } else {
    constexpr int kTightest = -12, kLoosest = -2;
    decade_slider("tolerance", settings.tolerance, kTightest, kLoosest);
    explain("tolerance");
  }
  if (diagonal > 0.0) {
    constexpr double kShortest = 0.01, kLongest = 100.0;
    double length = settings.max_length > 0.0 ? settings.max_length / diagonal : kDefaultLength;
    if (slider_scalar("max length", ImGuiDataType_Double, &length, &kShortest, &kLongest, "%.2f diagonals",
                      ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp)) {
      settings.max_length = length * diagonal;
    }
    explain("max-length");
  }
  constexpr double kMega = 1024.0 * 1024.0;
  double memory = std::round(static_cast<double>(line_memory(settings)) / kMega);
  if (edit_setting("memory", memory)) settings.memory = memory;
}

/// Of the volume of a flow, in whose place its hand may feel something else.
std::optional<double> seen_at_probe(const PanelState& state, const VolumeView& volume) {
  if (state.touch == nullptr || !state.touch->readout().held) return std::nullopt;
  const double value = volume.image->value_at(state.touch->readout().proxy);
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// Which scalar of a flow is a volume, and from how many points. What lies on no grid along straight axes is resampled as soon
/// as it is chosen, which is what asks for it.
void choose_flow_volume(VolumeOptions& settings, const SceneInfo& info, std::vector<std::string>& volumes) {
  constexpr const char* kNothing = "nothing";
  constexpr const char* kFirstTry = "64";
  if (begin_combo("volume of", volumes.empty() ? kNothing : volumes.front().c_str())) {
    if (selectable(kNothing, volumes.empty())) volumes.clear();
    for (const std::string& name : info.volumes) {
      const bool chosen = !volumes.empty() && name == volumes.front();
      if (!selectable(name.c_str(), chosen) || chosen) continue;
      std::erase(volumes, name);
      // It takes the place of the one that was shown.
      if (volumes.empty()) {
        volumes.push_back(name);
      } else {
        volumes.front() = name;
      }
      settings.transfer.clear();  // of other values
      settings.focus.clear();
      if (info.resampled && settings.resample.empty()) settings.resample = kFirstTry;
    }
    ImGui::EndCombo();
  }
  hint("a scalar that is drawn around the lines");
  if (volumes.empty()) return;
  std::string resample = settings.resample;
  if (input_text("resample", &resample, ImGuiInputTextFlags_EnterReturnsTrue)) settings.resample = resample;
  explain("resample");
}

void draw_flow_volume(PanelState& state, const SceneState& scene, std::optional<VolumeView>& volume,
                      PanelActions& actions) {
  if (!section("VOLUME")) return;
  VolumeOptions& settings = state.document.volume;
  std::vector<std::string> volumes;
  if (!settings.scalar.empty()) {
    for (const std::string_view name : split(settings.scalar, ',')) volumes.emplace_back(name);
  }
  choose_flow_volume(settings, *scene.info, volumes);
  settings.scalar = joined(volumes, ",");
  if (!volume || volumes.empty()) return;
  edit_setting("show-volume", volume->shown);
  draw_values_at_probe(state, scene.volume_label, *volume);
  std::vector<std::string> beside(volumes.begin() + 1, volumes.end());
  draw_volume_appearance(state, scene, volumes.front(), scene.info->volumes, beside,
                         seen_at_probe(state, *volume), *volume, actions);
  volumes.resize(1);
  volumes.insert(volumes.end(), beside.begin(), beside.end());
  settings.scalar = joined(volumes, ",");
}

}  // namespace

std::vector<PanelPart> flow_panels() {
  return {[](PanelContext& on) { draw_lines(on.state, on.scene); }, draw_line_colors,
          [](PanelContext& on) {
            if (!on.scene.info->volumes.empty())
              draw_flow_volume(on.state, on.scene, on.view.volume, on.actions);
          }};
}

}  // namespace palpate
