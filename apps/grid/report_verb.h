/// The report on a volume: what ways to draw it faster cost in errors of its picture.
#pragma once

#include <vector>

#include "common/cli/explorer.h"

namespace palpate {

/// @pre the explorer is about scalars.
[[nodiscard]] Verb volume_report_verb(std::vector<UsageExample> examples);

}  // namespace palpate
