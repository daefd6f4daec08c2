/// The type of the voxels that verbs of `grid` write: that of the data, or the one of `--type`.
#pragma once

#include <string>

#include "common/field/data_set.h"
#include "common/load/write/image_origin.h"
#include "common/scene/document/document.h"

namespace palpate {

/// @throws Error (usage) where `--type` is no type.
void check_type(const SliceOptions& options);

/// Has `values` have the type that is asked for, and `origin` not have numbers stored in another one.
/// @return what that costs, counted: a sentence, or nothing.
/// @throws Error (usage) where the values are colours.
[[nodiscard]] std::string take_type(const SliceOptions& options, DataArray& values, ImageOrigin& origin);

}  // namespace palpate
