/// Elements of openCARP, as its text and its binary files have them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "common/field/data_set.h"
#include "loaders/cardiac/mesh_text.h"

namespace palpate {

struct CarpCell {
  std::string_view word;
  std::uint8_t vtk;  ///< 0: one that is not read
  std::size_t corners;
};
/// In the order in which .belem numbers them, from 0.
inline constexpr std::array<CarpCell, 8> kCarpCells{{{"Tt", kVtkTetrahedron, 4},
                                                     {"Hx", kVtkHexahedron, 8},
                                                     {"Oc", 0, 6},
                                                     {"Py", kVtkPyramid, 5},
                                                     {"Pr", kVtkWedge, 6},
                                                     {"Qd", kVtkQuad, 4},
                                                     {"Tr", kVtkTriangle, 3},
                                                     {"Ln", kVtkLine, 2}}};

/// What stands in the rows of an .elem or .belem file.
struct CarpElements {
  UnstructuredTopology topology;  ///< prisms and hexahedra as the file has them
  std::vector<double> regions;
  std::map<std::string, std::size_t, std::less<>> labels;  ///< words behind the region, and in how many rows
  std::int64_t lowest = std::numeric_limits<std::int64_t>::max(), highest = -1;  ///< points that are named
};

}  // namespace palpate
