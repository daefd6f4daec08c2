/// The command line's spelling of how tracts are traced: group "Tracts".
#pragma once

#include "common/cli/scene_options.h"
#include "common/scene/options.h"

namespace palpate {

/// Binds the options to `tracts`, which outlives `options`.
void add_tract_options(SceneOptions& options, TractTracingOptions& tracts);

}  // namespace palpate
