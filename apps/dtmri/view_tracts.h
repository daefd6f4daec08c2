/// Tracts that pictures and windows show: traced from the seeds that options name, or read from a file.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "common/base/progress.h"
#include "common/render/tensor/tensor_voxels.h"
#include "common/render/tract/tract_bundle.h"
#include "common/scene/document/document.h"

namespace palpate {

struct ViewTracts {
  std::shared_ptr<const TractBundle> bundle;  ///< not null
  std::size_t seeds = 0;                      ///< none of a file
  double seconds = 0.0;                       ///< that tracing took
  std::string why_none;                       ///< what became of the seeds, where there is no line
  std::string left_out;                       ///< what a picture has no room for; empty: it shows all lines
};

/// Checks what can be checked before anything is read. @throws Error (usage).
void check_view_tracts(const TractTracingOptions& options, const TractAppearance& look);

/// The lines of a tractogram. @throws Error (bad input): not readable, or no line in it; Cancelled.
[[nodiscard]] ViewTracts read_view_tracts(const TractAppearance& look, Progress* progress);

/// Traces through `voxels` as the verb `trace` does. @pre options.seeds is not empty.
/// @throws Error (usage), (bad input) as tract_options() and tract_seeds(); Cancelled.
[[nodiscard]] ViewTracts trace_view_tracts(const TractTracingOptions& options, const CommonOptions& common,
                                           const TensorVoxels& voxels, Progress* progress);

}  // namespace palpate
