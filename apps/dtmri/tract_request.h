/// What the options of tracts mean: seeds, regions and limits.
///
///   region    mask:FILE          where an image is above 0.5, trilinear
///             sphere:x,y,z,r     a ball
///   seeds     a region, or fa:T, cl:T: the voxels that it takes the centres of; of a mask its own voxels
///             whatever parse_seeds() knows that does not depend on a field: file.csv, point:, line:, plane:
#pragma once

#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/field/data_set.h"
#include "common/field/tensor/tensor_field.h"
#include "common/scene/document/document.h"
#include "common/trace/tract/trace_tracts.h"

namespace palpate {

/// Limits and regions; masks are read.
/// @throws Error (usage), (bad input) naming a mask; Cancelled.
[[nodiscard]] TractOptions tract_options(const TractTracingOptions& options, int threads,
                                         Progress* progress = nullptr);

/// @param image that `field` was made of.
/// @throws Error (usage) that shows the grammar, (bad input) naming a file; Cancelled.
[[nodiscard]] std::vector<Vec3> tract_seeds(const TractTracingOptions& options, std::uint64_t random_seed,
                                            const TensorField& field, const DataSet& image, int threads,
                                            Progress* progress = nullptr);

/// Of tracing that gave no line: what became of its seeds and lines, and by which option.
[[nodiscard]] std::string why_no_tract(const TractResult& result, const TractOptions& options);

}  // namespace palpate
