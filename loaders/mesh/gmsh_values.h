/// Values of a Gmsh file ($NodeData, $ElementData, $ElementNodeData), brought to the mesh that they are of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "loaders/mesh/mesh_file.h"

namespace palpate {

/// One section.
struct GmshValues {
  enum class On : std::uint8_t { kNodes, kElements, kElementNodes };
  struct Tuple {
    std::int64_t tag = 0;   ///< of the node or element
    std::size_t begin = 0;  ///< of its numbers
    std::size_t nodes = 1;  ///< for each of which there are `components` numbers
  };
  std::string name;
  On on = On::kNodes;
  bool coefficients = false;  ///< of functions, not values
  double time = 0.0;
  std::int64_t step = 0;
  int components = 1;
  std::vector<Tuple> tuples;
  std::vector<double> numbers;
};

struct GmshMesh {
  std::vector<double> positions;
  UnstructuredTopology cells;                                       ///< without positions
  std::unordered_map<std::int64_t, std::size_t> point_of, cell_of;  ///< by tag
  /// For each cell, which node of Gmsh's is each of its own; null: in their order.
  std::vector<const std::int8_t*> order_of;
};

/// Steps, times and notes of the mesh with its values. Where some are of the nodes of each element, cells have points of their own.
/// @throws Error (bad input) with `file`.
void add_gmsh_values(GmshMesh mesh, std::vector<GmshValues> values, const std::string& file, MeshFile& out);

}  // namespace palpate
