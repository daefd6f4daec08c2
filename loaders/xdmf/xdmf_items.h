/// DataItems of XDMF that libxdmf takes for something else, in words that it takes as the format means them.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace palpate {

/// The text of `file` with these DataItems replaced, and with names of files that hold from any folder; nothing where
/// there are none to replace ("XDMF Model and Format", DataItem).
/// - HyperSlab of an HDF5 array: libxdmf counts the axes of start, stride and count from the last one on.
/// - JOIN($0, $1, …) of as many scalars as the last axis has numbers: libxdmf puts them one behind the other.
/// Attributes of other functions, of coordinates and of slabs of anything else are taken out.
/// @param notes gets which, and why. @throws Error (bad input) with the line in `file`: slabs beyond their array, joined
/// items of different sizes.
[[nodiscard]] std::optional<std::string> with_plain_items(const std::string& file,
                                                          std::vector<std::string>& notes);

}  // namespace palpate
