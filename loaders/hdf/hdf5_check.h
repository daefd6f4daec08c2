/// A look at an HDF5 file before its reader sees it: readers allocate what its data sets claim, and what was never
/// written comes as zeros.
#pragma once

#include <string>

namespace palpate {

/// Files of other kinds pass. @throws Error (bad input) for a data set that claims more than the file can hold.
void check_hdf5(const std::string& file);

}  // namespace palpate
