/// Points of a mesh that no cell has.
#pragma once

#include <cstdint>
#include <vector>

#include "common/field/data_set.h"

namespace palpate {

/// One byte a point, 1 where a cell has it. Points that a cell names and that are not there are passed over.
[[nodiscard]] std::vector<std::uint8_t> points_of_cells(const UnstructuredTopology& mesh);

}  // namespace palpate
