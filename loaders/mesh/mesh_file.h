/// What a file of meshes holds, and the readers that find it out. No reader needs a library.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/field/data_set.h"

namespace palpate {

struct MeshFile {
  std::vector<double> times;  ///< rising; none for a single state
  /// The blocks at each time, with all arrays; one for a single state.
  std::vector<std::vector<DataSet>> steps;
  std::vector<std::string> notes;
  bool faces = false;  ///< surfaces with a number each were left out: BlockInfo::faces
};

/// Cells of an unstructured block while they are read. Those of volumes are kept; of others only the count.
class CellList {
 public:
  void add(std::uint8_t type, const std::int64_t* points, std::size_t count);
  [[nodiscard]] std::size_t size() const noexcept { return types_.size(); }
  /// The cells into a topology.
  void take(UnstructuredTopology& mesh);

 private:
  std::vector<std::uint8_t> types_;
  std::vector<std::int64_t> offsets_{0}, connectivity_;
};

/// Values of a mesh that are known by name, as an array; those that are not are NaN.
[[nodiscard]] DataArray mesh_array(const std::string& name, Association association, int components,
                                   const std::vector<double>& values);

/// Gmsh's .msh, 2.2 and 4.1, text and binary ("MSH file format" of its manual): volumes with node and element data. Where
/// physical groups of surfaces name those of a heart's wall (surfaces_of_faces()), or `surface_markers` means them by their
/// numbers, there is the point array "surface". @param surface_markers LoadRequest::surface_markers of a wall; null: of anything
/// else, whose faces are not kept.
/// @throws Error (bad input) with `file`, as the next; (usage) for `surface_markers` that are none.
[[nodiscard]] MeshFile read_gmsh(std::string_view text, const std::string& file,
                                 const std::optional<std::string>& surface_markers = {});
/// SU2's native mesh ("Mesh File" of its documentation), which holds no values.
[[nodiscard]] MeshFile read_su2(std::string_view text, const std::string& file);
/// Tecplot's ASCII data ("ASCII Data", Tecplot 360 Data Format Guide): ordered and finite-element zones.
[[nodiscard]] MeshFile read_tecplot(std::string_view text, const std::string& file);
/// AVS's unstructured cell data in text.
[[nodiscard]] MeshFile read_ucd(std::string_view text, const std::string& file);

}  // namespace palpate
