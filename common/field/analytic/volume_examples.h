/// Built-in volumes: made on the fly, and handed over as a loader would, in the types that files have.
#pragma once

#include <string_view>
#include <vector>

#include "common/field/analytic/examples.h"
#include "common/field/data_set.h"

namespace palpate {

/// Name of the array of built-in volumes.
inline constexpr const char* kVolumeArray = "scalars";

/// All of them; the first is the one shown by default.
[[nodiscard]] std::vector<ExampleInfo> volume_examples();

/// One uniform block with one point array.
/// @throws Error (usage) that lists the known ones.
[[nodiscard]] DataSet volume_example(std::string_view name);

}  // namespace palpate
