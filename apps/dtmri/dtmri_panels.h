/// The parts of the panel about slices, glyphs, tracts and the volume of anisotropy.
#pragma once

#include <vector>

#include "common/window/panels/panel.h"

namespace palpate {

[[nodiscard]] std::vector<PanelPart> dtmri_panels();

}  // namespace palpate
