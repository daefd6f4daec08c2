/// Points that a mesh has several times.
#pragma once

#include <cstdint>
#include <vector>

#include "common/field/data_set.h"

namespace palpate {

/// For every point the first one at its place; those that are nowhere stand for themselves.
[[nodiscard]] std::vector<std::int64_t> first_at_place(const DataArray& positions);

}  // namespace palpate
