/// Coordinates of a heart's wall at the points of its mesh: `map --coordinates`.
#pragma once

#include "common/cli/explorer.h"

namespace palpate {

/// @throws Error as open_wall(), make_wall_coordinates() and write_mesh(); (usage) where an angle or contours are
/// asked for, too.
[[nodiscard]] ExitCode map_coordinates(const Document& options, const VerbContext& context);

}  // namespace palpate
