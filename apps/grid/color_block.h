/// The colours of an image.
#pragma once

#include <optional>

#include "common/base/progress.h"
#include "common/field/data_set.h"
#include "common/scene/input.h"

namespace palpate {

/// The colours of the voxels, where the volume has some and nothing else is asked for.
[[nodiscard]] std::optional<DataSet> color_block(Input& input, Progress* progress);

}  // namespace palpate
