/// The part of the touch panel about isosurfaces that are felt: their values over the histogram of the data,
/// which way they hold, and how deep.
#pragma once

#include <optional>
#include <string>

#include "common/hand/mode/haptic_surfaces.h"
#include "common/haptics/constraint/isosurface_settings.h"

namespace palpate {

/// Draws the controls and changes `settings`. Isovalues that were left to the mode's choice become settings
/// once one is edited, added or removed.
/// @param felt what is felt now.  @param fraction as HapticSurfaces::fraction().
/// @param mode by name: the isosurface mode alone lets its hold be chosen; layers hold as such.
/// @param flow whether a streamline can lead to the surface.
void edit_isosurfaces(IsosurfaceSettings& settings, const HapticLevels& levels,
                      const HapticSurfaces::Made& made, std::optional<double> fraction,
                      const std::string& mode, bool flow);

/// The isovalues with another one, in the middle of the widest gap that they leave in [lowest, highest].
/// @pre isovalues.count < Isovalues::kMax.
[[nodiscard]] Isovalues with_another(const Isovalues& isovalues, double lowest, double highest);

}  // namespace palpate
