/// The verb that opens the window.
#pragma once

#include "common/cli/explorer.h"

namespace palpate {

[[nodiscard]] Verb open_verb(std::vector<UsageExample> examples);

}  // namespace palpate
