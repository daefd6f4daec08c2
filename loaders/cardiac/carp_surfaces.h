/// Surfaces of openCARP's meshes, as meshtool and others write them: .surf (triangles and quads), .neubc
/// (triangles that carry loads) and .vtx (points).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/field/data_set.h"

namespace palpate {

/// Whether an ending is one of theirs.
[[nodiscard]] bool is_carp_surface(const std::string& ending);

/// Files beside a mesh that begin with its name and name a surface: STEM.epi.surf, STEM_lvendo.vtx. Of one surface in both
/// forms the triangles.
/// @param stem the mesh's file without its ending.
[[nodiscard]] std::vector<std::string> surfaces_beside(const std::string& stem);

/// Makes the point array "surface" (wall_surfaces.h) of files that say in their name what they are (role_of_name()). A
/// point of several is of one as in PointTags. Without an inner and an outer surface there is no array.
/// @param stem that of the mesh, which says nothing. @param first 0 or 1: the number of the first point.
/// @param notes gets what was taken, and what was left out.
/// @throws Error (bad input) naming file and line.
void add_carp_surfaces(const std::vector<std::string>& files, const std::string& stem, std::int64_t first,
                       DataSet& mesh, std::vector<std::string>& notes);

}  // namespace palpate
