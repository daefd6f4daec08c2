/// What the reports of all explorers have in common: how they begin, and how they are written and told.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/cli/explorer.h"
#include "common/scene/input.h"
#include "common/scene/plan.h"
#include "lab/report.h"

namespace palpate {

/// A report of `input` on this machine; its scene begins with what was chosen of the input.
[[nodiscard]] Report begin_report(const Input& input, const VerbContext& context);

/// Moves `from` behind what is there.
void append(std::vector<StabilityCase> from, std::vector<StabilityCase>& to);

/// Points of all diagrams.
[[nodiscard]] std::size_t work_precision_rows(const Report& report);

/// Writes the report to options.out, then prints its title, `figures`, each case with its limit, with
/// --explain what the input cost, and with --json a summary.
/// @param figures lines of text, may be empty. @param rows how many of them were measured.
/// @throws Error as write_report().
void finish_report(const Report& report, const std::string& figures, std::size_t rows,
                   const std::vector<MeasuredCost>& costs, const Options& options,
                   const VerbContext& context);

}  // namespace palpate
