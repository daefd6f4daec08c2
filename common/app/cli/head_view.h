/// A picture as a screen of a workbench shows it to a head before it.
#pragma once

#include "common/app/cli/options.h"
#include "common/render/scene_view.h"

namespace palpate {

/// Refuses what can be refused before data is read: a head without a workbench with a screen, a pose that is
/// none, a head behind the screen, a picture of another shape than the screen's. Nothing where no head is
/// asked for.
/// @param aspect width / height of an eye's picture. @throws Error.
void check_head(const Options& options, double aspect);

/// Puts the camera before the screen, with the eyes of the head: the middle of `view.bounds` is shown at
/// [interaction] middle, turned by its rotation, `gain` metres of the workspace for a metre there
/// (InteractionGeometry). Nothing where no head is asked for. @throws Error.
void take_head(const Options& options, SceneView& view);

}  // namespace palpate
