/// Meshes of TetGen, Chaste and CardioMechanics: .node and .ele, triangles of surfaces in .face, fibre
/// directions in .ortho, .axi or .bases.
///
/// A .bases file (CardioMechanics of the Karlsruhe Institute of Technology, user manual, "Fiber Orientation
/// File") begins with the counts of elements and of places in an element, centroid first, then its quadrature
/// points. A row is the element's number and nine numbers for each place: fibre, sheet and normal. Of five places
/// directions of points are made (element_frames.h). Of other counts the directions at the centroid are taken; they stay
/// constant in the element as those of the other files do.
#pragma once

#include <string>
#include <vector>

#include "common/field/data_set.h"

namespace palpate {

struct TetgenFiles {
  std::string node;
  std::string ele;
  std::string face;        ///< triangles, perhaps with markers; may be empty
  std::string directions;  ///< .ortho, .bases (fibre, sheet, normal) or .axi (fibre); may be empty
};

/// The set that `named` belongs to: files with the same stem (for directions also without "_quad" behind it)
/// beside it, unless they are named themselves.
/// @throws Error (bad input) where the nodes or the elements are missing, or two files play one part.
[[nodiscard]] TetgenFiles find_tetgen_files(const std::vector<std::string>& named);

/// Tetrahedra of 4 or 10 nodes, numbered from 0 or 1 as the first node is. Node attributes become point
/// arrays "attribute 1" …, element attributes cell arrays of that name, but for whole numbers in the first: "region"; directions cell arrays "fibre",
/// "sheet", "normal", or point arrays of these names. Which edge a fifth to tenth node halves is taken from where it lies.
/// Marked triangles become the point array "surface" (marked_faces.h).
/// @param surface_markers LoadRequest::surface_markers. @param notes gets what is to be said.
/// @throws Error (bad input) naming file and line, (usage) for markers that are none.
[[nodiscard]] DataSet read_tetgen(const TetgenFiles& files, const std::string& surface_markers,
                                  std::vector<std::string>& notes);

}  // namespace palpate
