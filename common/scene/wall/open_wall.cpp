#include "common/scene/wall/open_wall.h"

#include <algorithm>
#include <span>
#include <utility>

#include "common/base/error.h"
#include "common/field/heart/heart.h"
#include "common/scene/wall/remesh.h"

namespace palpate {

OpenWall open_wall(Input& input, std::vector<std::string> names, int threads, Progress* progress) {
  if (!input.not_volume().empty())
    throw input_error({input.title(), "", input.not_volume(), "a mesh of the wall"});
  for (const ArrayInfo& array : input.arrays())
    if (array.name == kSurfaceArray && array.components == 1 && array.association == Association::kPoint &&
        std::find(names.begin(), names.end(), array.name) == names.end())
      names.push_back(array.name);
  OpenWall wall{.mesh = read_wall(input, names, progress), .grid = {}, .surfaces = {}};
  if (progress) progress->begin("finding the surfaces of the wall", 0);
  join_same_points(wall.mesh);
  wall.grid = make_field_grid(std::span(&wall.mesh, 1), input.title(), threads);
  wall.surfaces = find_wall_surfaces(*wall.grid, wall.mesh, input.title());
  return wall;
}

}  // namespace palpate
