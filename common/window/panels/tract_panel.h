/// The part of the panel about tracts that are traced by rule: where they start and end, and how they look.
#pragma once

#include <optional>

#include "common/compose/window_model.h"
#include "common/render/scene_view.h"

namespace palpate {

/// Where tracts start, as the panel edits it.
struct TractSeedChoice {
  bool at_crosshair = true;      ///< in a ball about it; else wherever FA is above `least_fa`
  std::optional<double> radius;  ///< of the ball [data units]; none: three voxels
  double least_fa = 0.4;
};

/// `choice` as --seeds says it.
[[nodiscard]] std::string tract_seed_words(const TractSeedChoice& choice, const TensorView& tensors);

/// Edits `choice` and, when asked to trace or to remove the tracts, `settings`.
/// @param look of the tracts that are shown; none where none are.
void draw_tract_panel(TractSeedChoice& choice, SceneSettings& settings, const TensorView& tensors,
                      std::optional<TractView>& look);

/// Edits how tracts are drawn.
void draw_tract_look(TractView& look);

}  // namespace palpate
