/// What files that are dropped on a window together are to each other.
#pragma once

#include <filesystem>
#include <vector>

#include "common/compose/window_model.h"

namespace palpate {

/// Tells the solution of a PLOT3D grid from the grid, in whichever order they come. A solution alone goes with
/// the grid that is open.
/// @param open the files of what is open; null: nothing is.
[[nodiscard]] InputFiles sort_dropped(const std::vector<std::filesystem::path>& files,
                                      const InputFiles* open);

}  // namespace palpate
