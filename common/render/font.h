/// The font of overlay and panels.
#pragma once

struct ImFontAtlas;

namespace palpate {

/// Adds DejaVu Sans, where the system has it, in `pixels` of height; else Dear ImGui's own font.
void add_font(ImFontAtlas& atlas, float pixels);

}  // namespace palpate
