/// The parts of the panel about lines, their colours, and scalars of the flow as a volume around them.
#pragma once

#include <vector>

#include "common/window/panels/panel.h"

namespace palpate {

[[nodiscard]] std::vector<PanelPart> flow_panels();

}  // namespace palpate
