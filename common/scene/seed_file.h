/// Seeds from a file: a table of coordinates, or the points of any data file that can be opened.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

/// The points in data coordinates: rows of a CSV file whose header has columns x, y and z; or all points of
/// all blocks of a data file (its loader's helper program reads it), points that are not finite left out.
/// @throws Error (bad input) naming the file, and the line of a table; (usage) for more than `most` points.
[[nodiscard]] std::vector<Vec3> read_seed_file(const std::string& file, std::size_t most);

}  // namespace palpate
