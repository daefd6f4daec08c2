/// Points of a mesh that lie at the very same place, as files have them whose parts were put together without
/// being joined: cells on either side of them have no face in common, and the wall has a crack.
#pragma once

#include <cstddef>

#include "common/field/data_set.h"

namespace palpate {

/// Lets the cells of an unstructured mesh name the first of all points at one place (equal coordinates, to
/// the last bit); the others stay, without a cell. Other topologies are left as they are.
/// @return how many points are named no more.
std::size_t join_same_points(DataSet& mesh);

}  // namespace palpate
