/// The mode `linear`: a linear constraint (haptics/constraint/linear.h) in directions of the data, by a rule
/// for each axis: its settings as options.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/hand/mode/haptic_mode.h"
#include "common/haptics/constraint/linear_settings.h"
#include "common/scene/touch_spec.h"

namespace palpate {

/// @throws Error (usage) that names the option, what it expects and what it found.
[[nodiscard]] LinearSettings linear_settings(const LinearSpec& spec);

/// The same as spec.
[[nodiscard]] LinearSpec linear_text(const LinearSettings& settings);
/// The settings as options, names without dashes: linear_settings() reads them back, thresholds to rounding.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> linear_options(const LinearSettings& settings);

}  // namespace palpate
