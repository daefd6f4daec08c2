/// An input whose cells have given way to tetrahedra that a program fills its wall with.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/field/data_set.h"

namespace palpate {

class Input;

struct Remeshed {
  DataSet mesh;  ///< its topology, and arrays of points that the file does not give
  /// For each point of `mesh` which of the file's it is: its point arrays come along, those of cells do not.
  /// Empty where all points are new: then there are no arrays but those of `mesh`.
  std::vector<std::uint32_t> point_of_file;
  std::vector<std::string> notes;
};

/// @param input as the file has it, open at its time step. @throws Error, Cancelled.
using Remesher = std::function<Remeshed(Input& input, Progress* progress)>;

/// The arrays of the file at the points of the mesh. @pre point_of_file is not empty and names points of
/// `block`.
[[nodiscard]] std::vector<DataArray> carried_arrays(const DataSet& block,
                                                    const std::vector<std::uint32_t>& point_of_file);

}  // namespace palpate
