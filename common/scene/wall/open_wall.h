/// The wall of a heart in an input, with or without fibres, and its surfaces.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/field/data_set.h"
#include "common/field/field_grid.h"
#include "common/field/layer/wall_surfaces.h"
#include "common/scene/input.h"

namespace palpate {

struct OpenWall {
  DataSet mesh;  ///< points at one place are joined and all but tissue is hidden, as make_heart() does
  std::shared_ptr<const FieldGrid> grid;
  WallSurfaces surfaces;
  std::vector<std::string> notes;  ///< what was left out as no tissue, and notes_of() the surfaces
};

/// Reads the mesh with the arrays `names` and, where the file has it, the array kSurfaceArray.
/// @throws Error (bad input) where there is no wall or it has no surfaces; Cancelled.
[[nodiscard]] OpenWall open_wall(Input& input, std::vector<std::string> names, int threads,
                                 Progress* progress);

}  // namespace palpate
