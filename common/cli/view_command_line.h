/// The command line's spelling of how data is drawn: group "View".
#pragma once

#include "common/cli/explorer.h"
#include "common/cli/scene_options.h"
#include "common/scene/options.h"

namespace palpate {

/// --focal alone.
void add_focal_option(SceneOptions& options, ViewOptions& view);
/// Binds the options to parts of `bound`, which outlives `options`. @param kind of the explorer's fields.
void add_view_options(SceneOptions& options, Options& bound, FieldKind kind);

}  // namespace palpate
