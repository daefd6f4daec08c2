/// The part of the panel for regions that tracts are traced by.
#pragma once

#include <optional>
#include <string>

#include "apps/dtmri/region_text.h"
#include "common/window/panels/panel.h"

namespace palpate {

/// What the part remembers between frames.
struct RegionsPanel {
  RegionRole role = RegionRole::kInclude;  ///< of the next region
  std::string file = "regions.nii.gz";     ///< that they are written to
};

/// Balls, boxes, half-spaces and painted strokes, added at the crosshair or by the brush on slices, edited, removed and
/// written; each change is one of the document, so that it is undone and saved like all others. What is being painted is
/// outlined in `on.view`.
void draw_regions(RegionsPanel& panel, PanelContext& on);

}  // namespace palpate
