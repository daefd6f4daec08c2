/// Triangles of a .face file (TetGen, Chaste) that say which points of a wall lie on its surfaces.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/field/data_set.h"

namespace palpate {

/// Reads a .face file: the count and whether there are markers, then a row a triangle: its number, three or
/// six nodes, the marker, perhaps the elements on both sides (tetgen -nn). Triangles with marker 0 are on no
/// surface.
///
/// What the other markers mean is asked for, or taken from the shape of all triangles of one marker, as
/// find_wall_surfaces() does with the smooth parts of a border: below 1 % of the area they are left out, flat
/// ones are cuts, of the others that with the larger extent is the outer surface and the other the inner one; more than two
/// mean nothing. Points of both are inner ones (PointTags). The point array "surface" says so. Without two
/// markers that differ, or where their shapes tell no inner surface, there is none, and a note says that.
/// @param first_node the number of the first node, 0 or 1.
/// @param markers as parse_surface_markers() takes them; empty: by shape.
/// @param mesh tetrahedra of 4 or 10 nodes.
/// @throws Error (bad input) naming file and line for what is no triangle of an element; (usage) for
/// `markers` that are none, or that the file does not have.
void add_marked_surfaces(const std::string& file, std::int64_t first_node, const std::string& markers,
                         DataSet& mesh, std::vector<std::string>& notes);

}  // namespace palpate
