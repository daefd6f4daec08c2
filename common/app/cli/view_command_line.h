/// The command line's spelling of how data is drawn: group "View".
#pragma once

#include "common/app/cli/explorer.h"
#include "common/app/cli/options.h"
#include "common/app/cli/scene_options.h"

namespace palpate {

/// --focal alone.
void add_focal_option(SceneOptions& options, ViewOptions& view);
/// Binds the options to parts of `bound`, which outlives `options`. @param kind of the explorer's fields.
void add_view_options(SceneOptions& options, Options& bound, FieldKind kind);

}  // namespace palpate
