/// A look at a CGNS file in HDF5 before its reader sees it, which takes what there is of arrays that are too short.
#pragma once

#include <string>

namespace palpate {

/// Coordinates and solutions have the size of their zone, lists of cells that of their range.
/// Files of other kinds pass, and what has rinds, lists of points, or cells of several kinds. CGNS SIDS, "Zone structure
/// definition", "Grid coordinates, elements and flow solutions".
/// @pre check_hdf5(file) passed. @throws Error (bad input).
void check_cgns(const std::string& file);

}  // namespace palpate
