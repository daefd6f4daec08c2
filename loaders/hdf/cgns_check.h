/// A look at a CGNS file in HDF5 before its reader sees it, which takes what there is of arrays that are too short.
#pragma once

#include <string>
#include <vector>

namespace palpate {

/// Coordinates and solutions have the size of their zone, lists of cells that of their range.
/// Files of other kinds pass, and what has rinds, lists of points, or cells of several kinds. CGNS SIDS, "Zone structure
/// definition", "Grid coordinates, elements and flow solutions".
/// Coordinates are Cartesian; where cells have values, elements of borders are numbered behind those of the volume, which is never behind
/// as many as there are cells; and names, labels and types have the length that the format gives them:
/// VTK's reader makes other things of them without a word.
/// @param notes gets a WARNING where a zone has one array several times and nothing says at which time.
/// @returns the units of the file ("coordinates in mm"), or empty.
/// @pre check_hdf5(file) passed. @throws Error (bad input).
std::string check_cgns(const std::string& file, std::vector<std::string>& notes);

}  // namespace palpate
