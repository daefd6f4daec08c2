/// The verb that holds tracts of any program against an image, turns them on request and writes them.
#pragma once

#include <vector>

#include "common/cli/explorer.h"

namespace palpate {

/// `dtmri tracts IMAGE --tracts tracts.trk --turn=-x,-y,z --out turned.tck`
[[nodiscard]] Verb tracts_verb(std::vector<UsageExample> examples);

}  // namespace palpate
