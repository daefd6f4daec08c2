/// Writer of tetrahedra with numbers at their points or in their cells: .vtu, or .csv for the points alone. Written under a
/// temporary name and renamed, so an output is never half a file.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

/// Numbers at the points of a mesh, or in its cells.
struct MeshColumn {
  std::string name;
  std::vector<double> values;  ///< of all points or cells, `components` each
  std::size_t components = 1;
  bool of_cells = false;
};

/// Checks that `path` has a known ending, may be written, and does not exist unless `overwrite`; call it
/// before the work starts.
/// @throws Error (usage, or work failed where the folder cannot be written).
void check_mesh_output(const std::filesystem::path& path, bool overwrite);

/// .vtu is VTK XML with appended data that zlib has packed; .csv has the header x,y,z and the names of the columns, several
/// numbers a point as name_1, name_2, …; it has no cells, and no numbers of them.
/// @param long_axis of a heart, from apex to base: .vtu keeps it as the field data kLongAxisArray.
/// @throws Error as check_mesh_output(); (work failed) where the disk refuses.
void write_mesh(const std::filesystem::path& path, std::span<const Vec3> points,
                std::span<const std::array<std::uint32_t, 4>> cells, std::span<const MeshColumn> columns,
                bool overwrite, const std::optional<Vec3>& long_axis = {});

}  // namespace palpate
