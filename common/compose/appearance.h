/// How a scene is drawn, whatever it is of: background, axes and legends, and how lines are coloured. What the
/// document says goes into the view of a window and into that of a picture alike; view_keep.h is the way back.
#pragma once

#include <optional>
#include <string>

#include "common/render/scene_view.h"
#include "common/scene/document/document.h"

namespace palpate {

/// "dark", "light" or "r,g,b", each in [0, 1] (sRGB). @throws Error (usage).
[[nodiscard]] Background parse_background(const std::string& text);
[[nodiscard]] std::string background_text(const Background& background);

/// `--range`; none where it is not given. @throws Error (usage).
[[nodiscard]] std::optional<ValueRange> range_of(const ViewOptions& options);

/// The style of lines where nothing is said: fibres of a heart are thin, and lie too close for halos.
[[nodiscard]] LineStyle default_line_style(FieldKind kind);

/// Colours lines by the quantity that `--color` names; by what they were where it names none.
void show_quantity(const std::string& color, LineStyle& style);

/// What the document says about colours of lines: the quantity, where `--color` names one, their map and range.
/// @throws Error (usage).
void apply_colors(const ViewOptions& options, LineStyle& style);

/// The colours, and all else that the document says of how a scene is drawn. @throws Error (usage).
void apply_appearance(const Document& document, SceneView& view);

}  // namespace palpate
