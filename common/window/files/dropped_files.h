/// What files that are dropped on a window together are to each other.
#pragma once

#include <filesystem>
#include <vector>

#include "common/compose/window_model.h"

namespace palpate {

/// Sorts files by what they are, in whichever order they come: the solution of a PLOT3D grid, which alone goes with
/// the grid that is open; a session; tables of seeds and transfer functions, by their first line; data.
/// @param open the files of what is open; null: nothing is.
/// @param beside gets tracts that come with other data: they are opened after these.
/// @throws Error (usage) for two sessions, or two tables of one kind, naming both.
[[nodiscard]] InputFiles sort_dropped(const std::vector<std::filesystem::path>& files, const InputFiles* open,
                                      std::vector<InputFiles>& beside);

}  // namespace palpate
