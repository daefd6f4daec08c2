/// Small parts that panels share.
#pragma once

#include <imgui.h>

namespace palpate {

/// Millimetres a metre: lengths of the workspace are shown in these.
inline constexpr double kMillimetres = 1e3;

/// A slider that never leaves [lower, upper], typed in or not. @return whether `value` changed.
inline bool slider(const char* label, double& value, double lower, double upper, const char* format,
                   ImGuiSliderFlags flags = 0) {
  return ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &lower, &upper, format,
                             flags | ImGuiSliderFlags_AlwaysClamp);
}

}  // namespace palpate
