/// The parts of the panel about the layer that is shown, its fibres and its colours.
#pragma once

#include <vector>

#include "common/window/panels/panel.h"

namespace palpate {

[[nodiscard]] std::vector<PanelPart> cardiac_panels();

}  // namespace palpate
