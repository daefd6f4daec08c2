/// A look at an HDF5 file before its reader sees it: readers allocate what its data sets claim, and what was never
/// written comes as zeros.
#pragma once

#include <string>

namespace palpate {

/// Files of other kinds pass. @throws Error (bad input) for a data set that claims more than the file can hold.
void check_hdf5(const std::string& file);

/// Refuses a VTKHDF file of another version than VTK 9.1 reads, which is 1, and passes what states none; refuses images
/// that its reader fails on: flat ones, those that do not begin at 0, and those with values of cells.
/// @throws Error (bad input).
void check_vtkhdf(const std::string& file);

}  // namespace palpate
