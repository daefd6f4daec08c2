/// What lies over and below the picture: read-outs, the status line, the cheat sheet.
#pragma once

#include <string>

#include <imgui.h>

#include "common/window/panels/panel.h"

namespace palpate {

/// Of panels that stay where they are put.
constexpr ImGuiWindowFlags kFixedPanel =
    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

/// "300 lines", or "103 x 94 x 161 voxels" of a volume.
[[nodiscard]] std::string size_text(const SceneState& scene);

/// Banners and the cheat sheet alone; closing these changes `state`.
void draw_overlays(PanelState& state, const WindowLayout& layout);

/// Draws all, with these.
void draw_picture_panels(PanelState& state, const WindowLayout& layout);

}  // namespace palpate
