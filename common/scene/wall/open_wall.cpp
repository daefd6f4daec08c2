#include "common/scene/wall/open_wall.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "common/base/error.h"
#include "common/field/heart/heart.h"
#include "common/field/heart/tissue.h"
#include "common/field/layer/paint_surfaces.h"
#include "common/scene/wall/remesh.h"

namespace palpate {

OpenWall open_wall(Input& input, std::vector<std::string> names, int threads, Progress* progress) {
  if (!input.not_volume().empty())
    throw input_error({input.title(), "", input.not_volume(), "a mesh of the wall"});
  for (const ArrayInfo& array : input.arrays())
    if (array.name == kSurfaceArray && array.components == 1 && array.association == Association::kPoint &&
        std::find(names.begin(), names.end(), array.name) == names.end())
      names.push_back(array.name);
  // Fibres and regions say where tissue is, and are no part of what is asked for.
  std::vector<std::string> all = names;
  std::optional<DirectionChoice> fibre;
  if (!fibre_choices(input.arrays()).empty()) fibre = input.heart_choice().fibre;
  if (fibre) all.push_back(fibre->array);
  if (const std::string regions = region_array(input.arrays());
      fibre && !regions.empty() && std::find(all.begin(), all.end(), regions) == all.end())
    all.push_back(regions);
  OpenWall wall{.mesh = read_wall(input, all, progress), .grid = {}, .surfaces = {}, .notes = {}};
  if (progress) progress->begin("finding the surfaces of the wall", 0);
  join_same_points(wall.mesh);
  if (fibre) wall.notes = hide_all_but_tissue(wall.mesh, *fibre).notes;
  std::erase_if(wall.mesh.arrays, [&names](const DataArray& array) {
    return std::find(names.begin(), names.end(), array.name) == names.end();
  });
  wall.grid = make_field_grid(std::span(&wall.mesh, 1), input.title(), threads);
  wall.surfaces =
      find_painted_surfaces(*wall.grid, wall.mesh, input.title(), parse_paint(input.spec().paint));
  for (std::string& note : notes_of(wall.surfaces)) wall.notes.push_back(std::move(note));
  return wall;
}

}  // namespace palpate
