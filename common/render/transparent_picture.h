/// Pictures without a background.
#pragma once

#include "common/render/scene_view.h"

namespace palpate {

/// Draws `view` off-screen on two flat backgrounds b1 and b2, and takes from the pictures p1 and p2 what stands on
/// them (Smith and Blinn 1996, "Blue screen matting", theorem 3: the triangulation solution):
///
///   alpha = 1 - (p1 - p2) / (b1 - b2),   colour = (p1 - (1 - alpha) b1) / alpha
///
/// exact up to rounding for whatever is blended over a background; what takes its colour, as halos do, becomes
/// transparent. Both backgrounds are dark, or both light, as that of `view` is: words keep their colour.
/// @return colour that is not multiplied by alpha, as PNG has it. @throws Error as render_panes().
[[nodiscard]] Image transparent_picture(SceneView view, int width, int height);

}  // namespace palpate
