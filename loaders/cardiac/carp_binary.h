/// Binary meshes of openCARP: .bpts, .belem and .blon, packed with gzip or not.
///
/// Each begins with 1024 bytes of text: "COUNT ORDER CHECKSUM", of .blon "DIRECTIONS COUNT ORDER CHECKSUM", where
/// ORDER is 0 for the lowest byte first, 1 for the highest. Then come three floats a point; the number of its kind
/// (kCarpCells), its points and its region of each element, whole numbers of 4 bytes; three or six floats an element.
/// Programs sum different things up for CHECKSUM: the size of the file says whether it is whole. Format: meshtool's
/// reader and writer (io_utils.cpp).
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

/// An element of openCARP, as its text and its binary files have it.
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

/// By its ending.
[[nodiscard]] bool is_binary_carp(const std::string& file);

/// Three coordinates a point, in the file's unit.
/// @throws Error (bad input) with file and place where the header does not say so, the file is shorter or longer than
/// it says, or a coordinate is not finite; so do those below.
[[nodiscard]] std::vector<double> read_binary_points(const std::string& file);

/// @param points of the mesh; one more may be named, where they count from 1.
[[nodiscard]] CarpElements read_binary_elements(const std::string& file, std::size_t points);

/// How many the header speaks of. @throws as above.
[[nodiscard]] std::size_t count_binary_elements(const std::string& file);

/// One or two directions for each of `elements`.
[[nodiscard]] Directions read_binary_directions(const std::string& file, std::size_t elements);

}  // namespace palpate
