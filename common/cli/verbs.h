/// The verbs that all explorers share; each stands in a file of its own (verb_<name>.cpp).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/cli/explorer.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/scene/input.h"

namespace palpate {

[[nodiscard]] Verb info_verb(std::vector<UsageExample> examples);
/// @param modes the program's, the default one first.
[[nodiscard]] Verb probe_verb(std::vector<HapticMode> modes, std::vector<UsageExample> examples);

/// @name What the verbs share
/// @{

/// Handles `--example list`: prints the explorer's examples and returns true.
[[nodiscard]] bool list_examples(const Document& options, const VerbContext& context);

/// Opens the input and says on stderr which field and time step are taken.
[[nodiscard]] Input open_input(const Document& options, const VerbContext& context);

/// `<app>` alone where there is no display: a picture of the example that `options` name, under a name that
/// is free.
/// @param render the explorer's verb that draws. @param next another command to try, without the program's
/// name.
/// @throws as the verb.
ExitCode headless_tour(const Verb& render, Document options, const VerbContext& context,
                       const std::string& next);

/// Where there is no display and an input is named.
/// @throws Error (bad input) for a file that is missing or broken, the first thing to know; (work failed)
/// else.
[[noreturn]] void refuse_window(const Document& options, const VerbContext& context);
/// @}

/// Starts the program of studies (scene/report_request.h), shows what it says and prints what it answers.
/// Where this is cancelled, what it was writing is removed.
/// @param subject as ReportRequest has it. @param outputs that it writes: files, or folders.
/// @throws Error that it ended with; (work failed) where it is not installed or crashes; Cancelled.
void run_study(const std::string& subject, const Document& document,
               const std::vector<std::filesystem::path>& outputs, const VerbContext& context);

/// The verb `report` of an explorer, about its input. @param groups besides those of all reports.
[[nodiscard]] Verb report_verb(std::string summary, Groups groups, std::vector<UsageExample> examples);

}  // namespace palpate
