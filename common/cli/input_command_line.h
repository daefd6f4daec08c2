/// The command line's spelling of how a file is read: groups "Tensors" and "Voxels without a header".
#pragma once

#include "common/cli/scene_options.h"
#include "common/scene/options.h"

namespace palpate {

/// Binds the options to `tensor`, which outlives `options`.
void add_tensor_input_options(SceneOptions& options, TensorWords& tensor);

/// Binds the options to `raw`, which outlives `options`.
void add_raw_options(SceneOptions& options, RawWords& raw);

}  // namespace palpate
