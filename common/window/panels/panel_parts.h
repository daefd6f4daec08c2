/// Small parts that panels share.
#pragma once

#include <cstdarg>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <imgui.h>

#include "common/scene/document/setting.h"

namespace palpate {

/// @name Controls
/// Those of Dear ImGui under the same names, which are also noted by their labels: a script presses what is
/// called so, wherever it is.
/// @{
bool button(const char* label, const ImVec2& size = {0.0F, 0.0F});
bool small_button(const char* label);
bool checkbox(const char* label, bool* on);
bool selectable(const char* label, bool selected = false, ImGuiSelectableFlags flags = 0);
bool begin_combo(const char* label, const char* preview);
bool combo(const char* label, int* chosen, const char* const words[], int count);
bool slider_int(const char* label, int* value, int lower, int upper, const char* format = "%d",
                ImGuiSliderFlags flags = 0);
bool slider_scalar(const char* label, ImGuiDataType type, void* value, const void* lower, const void* upper,
                   const char* format, ImGuiSliderFlags flags = 0);
bool input_text(const char* label, std::string* text, ImGuiInputTextFlags flags = 0);
bool input_numbers(const char* label, double* values, int count, const char* format,
                   ImGuiInputTextFlags flags = 0);
bool drag_int(const char* label, int* values, int count, float speed, int lower, int upper,
              ImGuiSliderFlags flags);
bool color_edit(const char* label, float color[3], ImGuiColorEditFlags flags = 0);
/// Notes what was drawn last, a canvas say, or what is drawn there.
void note_control(const char* label);
void note_control(const char* label, const ImVec2& corner, const ImVec2& size);

/// A control that was drawn. The label is what is read of it: without its key, and without what follows "##"
/// unless that is all of it. The place of sliders, lists and fields is without the label beside them.
struct DrawnControl {
  std::string label;
  double left = 0.0, top = 0.0, width = 0.0, height = 0.0;  ///< in the window [pixels]
  std::string setting = {};  ///< the row that it edits, by edit_setting() or explain(); empty: none
  bool in_sight = true;      ///< its middle: not scrolled away
};
/// Those of the last frame that was complete, in the order in which they were drawn.
[[nodiscard]] const std::vector<DrawnControl>& drawn_controls() noexcept;
/// Scrolls to that one of the controls of this label, as a user would who looks for it.
/// @return whether to wait: it is on its way into sight. False where nothing brings it there.
[[nodiscard]] bool scrolls_to_control(const std::string& label, int which);
/// Begins a frame.
void begin_controls();
/// @}

/// The label of a setting in a panel: it begins small, but for abbreviations.
[[nodiscard]] std::string label_of(const Setting& row);

/// What the control that was drawn last is for, shown while the mouse is over it. printf's format.
void hint(const char* format, ...) IM_FMTARGS(1);

/// The same from the table of settings: its help, with range and default. The control is noted as that of the setting.
/// A right click offers the default, which take_reset() tells. @pre there is a setting of that name. @param resets false: it has no default to go back to.
void explain(const char* setting_name, bool resets = true);
/// The same of a row whose name others have, too; it cannot go back to its default here.
void explain(const Setting& row);
/// The help of that one alone.
void explain_setting(const Setting& row);

/// As much of `words` as there is room for [pixels], with "…" where some is left out.
[[nodiscard]] std::string shortened(std::string words, float room);

/// @name Settings that panels show, by explain() and edit_setting()
/// @{
/// The part of the panel that has a control of the setting now, folded or not; none: there is none.
[[nodiscard]] std::optional<std::string> place_of_setting(std::string_view name);
/// Has the next frames unfold that part, scroll there, and give the control the keyboard.
void go_to_setting(std::string_view name);
/// The setting whose default was asked for in this frame, where its control did not take it itself; asked once.
[[nodiscard]] std::optional<std::string> take_reset();
/// Forgets which parts are folded, and what panels of another window showed.
void forget_controls();
/// @}

/// @name Controls of settings
/// A slider, a box to tick, or a list of words: label, unit, range and words are those of the row in the table
/// of settings, its help is shown while the mouse is over it, and a right click offers its default. @pre there is a setting of that name, with a
/// bounded Range for numbers. @return whether the value changed.
/// @{
bool edit_setting(const char* setting_name, double& value,
                  double units = 1.0);  ///< @param units shown for one of it
bool edit_setting(const char* setting_name, int& value);
bool edit_setting(const char* setting_name, bool& on);
bool edit_setting(const char* setting_name, std::string& word);
/// An enumeration whose members count from 0, by name_of().
template <typename Enum>
requires std::is_enum_v<Enum>
bool edit_setting(const char* setting_name, Enum& value) {
  std::string word(name_of(value));
  if (!edit_setting(setting_name, word)) return false;
  for (int i = 0; name_of(value) != word; ++i) value = static_cast<Enum>(i);
  return true;
}
/// @}

/// Millimetres a metre: lengths of the workspace are shown in these.
inline constexpr double kMillimetres = 1e3;

/// Puts the next window of ImGui into the middle of the window.
void center_next_window();

/// The heading of a part of the panel; a click folds and unfolds the part.
/// @param folded whether it is, until it is clicked @param settings of one that is folded, which a search finds before they are drawn
/// @return whether its controls are to be drawn.
[[nodiscard]] bool section(const char* name, bool folded = false,
                           std::initializer_list<const char*> settings = {});
/// A heading alone.
void heading(const char* name);

/// A drop-down of words. @return whether another one was chosen.
bool choose_word(const char* label, std::string& chosen, const std::vector<std::string>& words);

/// A slider over decades, from 10^lower to 10^upper, on which it stays while it is dragged; what is typed is
/// taken as it is. @return whether `value` changed.
bool decade_slider(const char* label, double& value, int lower, int upper);

/// A slider that never leaves [lower, upper], typed in or not. @return whether `value` changed.
inline bool slider(const char* label, double& value, double lower, double upper, const char* format,
                   ImGuiSliderFlags flags = 0) {
  return slider_scalar(label, ImGuiDataType_Double, &value, &lower, &upper, format,
                       flags | ImGuiSliderFlags_AlwaysClamp);
}

/// Longer lists begin folded, and scroll in a window of their own.
inline constexpr std::size_t kShortList = 8;

/// An arrow before what comes next in its row, which folds the rows that belong to it. By the ids that are
/// pushed. @param at_first until the user has pressed it. @return whether these rows are to be drawn.
inline bool draw_fold(bool at_first) {
  note_control("##fold", ImGui::GetCursorScreenPos(),
               {ImGui::GetTreeNodeToLabelSpacing(), ImGui::GetFrameHeight()});
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

/// Rows of a name and its value, in two columns that line up.
class ReadoutRows {
 public:
  /// @param id tells tables of one frame apart.
  explicit ReadoutRows(const char* id) : open_(ImGui::BeginTable(id, 2, ImGuiTableFlags_SizingFixedFit)) {}
  ReadoutRows(const ReadoutRows&) = delete;
  ReadoutRows& operator=(const ReadoutRows&) = delete;

  /// The value as printf writes it.
  void add(const char* name, const char* format, ...) IM_FMTARGS(3) {
    if (!open_) return;
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", name);
    ImGui::TableNextColumn();
    std::va_list values;
    va_start(values, format);
    ImGui::TextV(format, values);
    va_end(values);
  }
  /// Call it before the window ends.
  void finish() {
    if (open_) ImGui::EndTable();
    open_ = false;
  }

 private:
  bool open_;
};

}  // namespace palpate
