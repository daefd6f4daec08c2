/// What workbench does.
#pragma once

#include <vector>

#include "common/cli/explorer.h"

namespace palpate {

/// @name Measurements and formulas, which the program of studies works on
/// @{
[[nodiscard]] Verb calibrate_verb(std::vector<UsageExample> examples);
/// A made table of measurements.
[[nodiscard]] Verb example_verb(std::vector<UsageExample> examples);
/// Made calibrations of every kind, and head tracking.
[[nodiscard]] Verb made_report_verb(std::vector<UsageExample> examples);
[[nodiscard]] Verb screen_verb(std::vector<UsageExample> examples);
[[nodiscard]] Verb stability_verb(std::vector<UsageExample> examples);
/// @}

/// @name Devices in the hand
/// @{
[[nodiscard]] Verb devices_verb(std::vector<UsageExample> examples);
[[nodiscard]] Verb doctor_verb(std::vector<UsageExample> examples);
[[nodiscard]] Verb monitor_verb(std::vector<UsageExample> examples);
[[nodiscard]] Verb feel_verb(std::vector<UsageExample> examples);
[[nodiscard]] Verb tune_verb(std::vector<UsageExample> examples);
/// A menu in space under a recorded stylus.
[[nodiscard]] Verb controls_verb(std::vector<UsageExample> examples);
/// @}

}  // namespace palpate
