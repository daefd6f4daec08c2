/// The mode `linear`: a linear constraint (haptics/constraint/linear.h) in directions of the data, by a rule
/// for each axis. flow and grid share it, and its options.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/app/haptic/haptic_mode.h"
#include "common/haptics/constraint/linear_settings.h"

namespace palpate {

inline constexpr const char* kLinearMode = "linear";

[[nodiscard]] HapticMode linear_mode();

/// The options of the mode as words of the command line.
struct LinearWords {
  std::string reference = "auto";       ///< name_of(LinearReference)
  std::string axes = "free,drag,drag";  ///< name_of(AxisRule) of each axis
  std::string tau = "4";                ///< drag thresholds [mm]: one for all axes, or three with '/' between
  std::string kappa = "1";              ///< stiffness factors, likewise
  std::string measure = "value";        ///< name_of(LinearMeasure): what curves take
  double friction = 0.0;
};

/// @throws Error (usage) that names the option, what it expects and what it found.
[[nodiscard]] LinearSettings linear_settings(const LinearWords& words);

/// The settings as options, names without dashes: linear_settings() reads them back, thresholds to rounding.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> linear_options(const LinearSettings& settings);

}  // namespace palpate
