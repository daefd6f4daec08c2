/// Meshes of TetGen and Chaste: .node and .ele, fibre directions in .ortho or .axi.
#pragma once

#include <string>
#include <vector>

#include "common/field/data_set.h"

namespace palpate {

struct TetgenFiles {
  std::string node;
  std::string ele;
  std::string
      directions;  ///< .ortho (fibre, sheet, normal) or .axi (fibre), one row an element; may be empty
};

/// The set that `named` belongs to: files with the same stem (for directions also without "_quad" behind it)
/// beside it, unless they are named themselves.
/// @throws Error (bad input) where the nodes or the elements are missing, or two files play one part.
[[nodiscard]] TetgenFiles find_tetgen_files(const std::vector<std::string>& named);

/// Tetrahedra of 4 or 10 nodes, numbered from 0 or 1 as the first node is. Node attributes become point
/// arrays "attribute 1" …, element attributes cell arrays of that name; directions cell arrays "fibre",
/// "sheet", "normal". Which edge a fifth to tenth node halves is taken from where it lies.
/// @param notes gets what is to be said.
/// @throws Error (bad input) naming file and line.
[[nodiscard]] DataSet read_tetgen(const TetgenFiles& files, std::vector<std::string>& notes);

}  // namespace palpate
