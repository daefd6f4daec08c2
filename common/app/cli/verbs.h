/// The verbs that all explorers share; each stands in a file of its own (verb_<name>.cpp).
#pragma once

#include <string>

#include "common/app/cli/explorer.h"
#include "common/app/haptic/haptic_mode.h"
#include "common/scene/input.h"
#include "common/scene/seeds.h"
#include "common/trace/trace.h"

namespace palpate {

[[nodiscard]] Verb info_verb(std::vector<UsageExample> examples);
[[nodiscard]] Verb trace_verb(std::vector<UsageExample> examples);
/// @param modes the program's, the default one first.
[[nodiscard]] Verb render_verb(std::vector<HapticMode> modes, std::vector<UsageExample> examples);
/// The same of volumes.
[[nodiscard]] Verb volume_render_verb(std::vector<UsageExample> examples);
/// @param modes the program's, the default one first.
[[nodiscard]] Verb probe_verb(std::vector<HapticMode> modes, std::vector<UsageExample> examples);
[[nodiscard]] Verb report_verb(std::vector<UsageExample> examples);

/// @name What the verbs share
/// @{

[[nodiscard]] InputSpec input_spec(const InputOptions& options, FieldKind kind = FieldKind::kVector);

/// Handles `--example list`: prints the explorer's examples and returns true.
[[nodiscard]] bool list_examples(const Options& options, const VerbContext& context);

/// Opens the input and says on stderr which field and time step are taken.
[[nodiscard]] Input open_input(const Options& options, const VerbContext& context);

/// Reads `--direction`, `--integrator` and the limits.
/// @param default_direction where `--direction` is not given.
/// @throws Error (usage).
[[nodiscard]] TraceOptions trace_options(const Options& options, const std::string& default_direction);

/// How many lines these seeds make: one each way.
[[nodiscard]] std::size_t line_count(const SeedSpec& seeds, const TraceOptions& trace) noexcept;
/// @}

}  // namespace palpate
