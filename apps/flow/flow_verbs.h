/// The verbs of flow fields.
#pragma once

#include <vector>

#include "common/cli/explorer.h"
#include "common/hand/mode/haptic_mode.h"

namespace palpate {

/// Streamlines, written as a file.
[[nodiscard]] Verb trace_verb(std::vector<UsageExample> examples);
/// A picture of lines and volume. @param modes the program's, the default one first.
[[nodiscard]] Verb render_verb(std::vector<HapticMode> modes, std::vector<UsageExample> examples);
/// The window.
[[nodiscard]] Verb open_lines_verb(std::vector<UsageExample> examples);

}  // namespace palpate
