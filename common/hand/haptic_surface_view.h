/// Isosurfaces that are felt, in a picture without a window.
#pragma once

#include <string>

#include "common/base/progress.h"
#include "common/field/scalar_field.h"
#include "common/render/scene_view.h"
#include "common/scene/document/document.h"

namespace palpate {

/// Whether the options speak of isosurfaces: by `--isovalue`, or as the mode that a path is felt in; not where
/// `--show-surfaces off` hides them.
/// @param mode that is taken, by name or by default.
[[nodiscard]] bool wants_surfaces(const Document& options, const std::string& mode);

/// Adds the isosurfaces of `field` that `--isovalue` names, or the one that parts its values best, and names
/// them in the subtitle.
/// @return what the user should know, on one line; empty: nothing.
/// @throws Error (usage), (work failed) where a surface is too large to be drawn; Cancelled.
[[nodiscard]] std::string show_haptic_surfaces(SceneView& view, const ScalarField& field,
                                               const TouchOptions& options, Progress* progress);

}  // namespace palpate
