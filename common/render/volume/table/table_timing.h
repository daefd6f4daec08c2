/// How long a compute shader takes to fill a preintegrated table, for reports.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "common/render/volume/table/preintegration.h"

namespace palpate {

/// Median of so many runs after the first one, to the end on the GPU [ms]. Nothing where the context that is
/// current has none, or is a software rasteriser, which takes seconds.
[[nodiscard]] std::optional<double> compute_table_ms(std::span<const OpticalEntry> entries,
                                                     std::size_t lengths, int repeats);

}  // namespace palpate
