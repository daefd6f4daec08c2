/// Colour bars and legends of the overlay: what the colours of lines, volumes, tensors and forces mean.
#pragma once

#include "common/render/overlay/overlay.h"
#include "common/render/overlay/overlay_pen.h"
#include "common/render/scene_view.h"

namespace palpate {

/// A column at the right border of a picture of that size.
void draw_colors(const OverlayPen& pen, const SceneView& view, const ColorLegend& legend, int width,
                 int height);

}  // namespace palpate
