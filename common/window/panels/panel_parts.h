/// Small parts that panels share.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <imgui.h>

namespace palpate {

/// Millimetres a metre: lengths of the workspace are shown in these.
inline constexpr double kMillimetres = 1e3;

/// The heading of a part of the panel.
void section(const char* name);

/// A drop-down of words. @return whether another one was chosen.
bool choose_word(const char* label, std::string& chosen, const std::vector<std::string>& words);

/// A slider over whole decades; a value between them stays until the slider is moved.
/// @return whether `value` changed.
bool decade_slider(const char* label, double& value, int lower, int upper);

/// A slider that never leaves [lower, upper], typed in or not. @return whether `value` changed.
inline bool slider(const char* label, double& value, double lower, double upper, const char* format,
                   ImGuiSliderFlags flags = 0) {
  return ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &lower, &upper, format,
                             flags | ImGuiSliderFlags_AlwaysClamp);
}

/// Longer lists begin folded, and scroll in a window of their own.
inline constexpr std::size_t kShortList = 8;

/// An arrow before what comes next in its row, which folds the rows that belong to it. By the ids that are
/// pushed. @param at_first until the user has pressed it. @return whether these rows are to be drawn.
inline bool draw_fold(bool at_first) {
  ImGui::SetNextItemOpen(at_first, ImGuiCond_Once);
  const bool open =
      ImGui::TreeNodeEx("##fold", ImGuiTreeNodeFlags_NoTreePushOnOpen | ImGuiTreeNodeFlags_FramePadding);
  ImGui::SameLine();
  return open;
}

/// Begins the window of a list of `count` entries, where it is long. @param rows that it shows at once.
/// @return whether ImGui::EndChild() is to follow the list.
inline bool begin_list(const char* name, std::size_t count, float rows) {
  if (count <= kShortList) return false;
  ImGui::BeginChild(name, {0.0F, rows * ImGui::GetFrameHeightWithSpacing()});
  return true;
}

}  // namespace palpate
