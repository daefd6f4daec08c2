/// The modes of placing things in a volume: `grid` leads the hand along the axes of a grid
/// (haptics/constraint/grid_axis.h), `plane-widget` lets it move and turn cutting planes (haptics/widget/). Their
/// settings as options.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/hand/mode/haptic_mode.h"
#include "common/haptics/constraint/grid_axis_settings.h"
#include "common/haptics/constraint/plane_widget_settings.h"
#include "common/scene/touch_spec.h"

namespace palpate {

/// @throws Error (usage) that names the option, what it expects and what it found.
[[nodiscard]] GridAxisSettings grid_settings(const GridSpec& words);
[[nodiscard]] PlaneWidgetSettings plane_settings(const PlaneSpec& words);

/// The same as words, lengths to rounding.
[[nodiscard]] GridSpec grid_text(const GridAxisSettings& settings);
[[nodiscard]] PlaneSpec plane_text(const PlaneWidgetSettings& settings);
/// Those of a grid as options, names without dashes.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> grid_options(const GridAxisSettings& settings);

}  // namespace palpate
