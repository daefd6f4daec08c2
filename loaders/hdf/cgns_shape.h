/// What VTK's reader of CGNS takes for granted: that dimensions, sizes of zones and lists of elements fit one another.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "loaders/hdf/cgns_file.h"

namespace palpate {

/// What is wrong with a node of a CGNS file.
struct CgnsProblem {
  std::string node, problem;
};

/// The number of nodes of an element by its kind (CGNS SIDS, ElementType_t); 0 where it is not known or not the
/// same for all.
[[nodiscard]] std::uint64_t nodes_of_element(std::int64_t kind) noexcept;

/// The first node that does not fit; empty where all do.
[[nodiscard]] CgnsProblem find_cgns_problem(const CgnsFile& file);

}  // namespace palpate
