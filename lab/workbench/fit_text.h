/// A fit's report for people and for programs.
#pragma once

#include <string>

#include "common/calibration/fit_report.h"

namespace palpate {

[[nodiscard]] std::string fit_text(const FitReport& report);
/// @param out the file that its section was written to; empty: none.
[[nodiscard]] std::string fit_json(const FitReport& report, const std::string& out);

}  // namespace palpate
