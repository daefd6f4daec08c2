/// Rows of a name and its value, in two columns that line up.
#pragma once

#include <cstdarg>

#include <imgui.h>

namespace palpate {

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
