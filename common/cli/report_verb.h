/// The verb `report`, and whatever else a program has studied: the program of studies does the work.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/cli/explorer.h"

namespace palpate {

/// Starts the program of studies (scene/report_request.h), shows what it says and prints what it answers.
/// Where this is cancelled, what it was writing is removed.
/// @param subject as ReportRequest has it. @param outputs that it writes: files, or folders.
/// @throws Error that it ended with; (work failed) where it is not installed or crashes; Cancelled.
void run_study(const std::string& subject, const Document& document,
               const std::vector<std::filesystem::path>& outputs, const VerbContext& context);

/// The verb `report` of an explorer, about its input. @param groups besides those of all reports.
[[nodiscard]] Verb report_verb(std::string summary, Groups groups, std::vector<UsageExample> examples);

}  // namespace palpate
