// Meshes that are read without a library. The first byte chooses the reader, so that one corpus serves all.
#include <cstdint>
#include <string_view>

#include "common/base/error.h"
#include "loaders/mesh/mesh_file.h"

using namespace palpate;

namespace {

/// What is handed over holds together: cells of points that there are, a value for each.
void check(const MeshFile& mesh) {
  for (const std::vector<DataSet>& blocks : mesh.steps) {
    for (const DataSet& block : blocks) {
      const std::size_t points = block.point_count(), cells = block.cell_count();
      for (const DataArray& array : block.arrays) {
        if (array.tuples != (array.association == Association::kPoint ? points : cells)) __builtin_trap();
      }
      const auto* const topology = std::get_if<UnstructuredTopology>(&block.topology);
      if (topology == nullptr) continue;
      if (topology->offsets.size() != cells + 1) __builtin_trap();
      for (const std::int64_t point : topology->connectivity) {
        if (point < 0 || static_cast<std::size_t>(point) >= points) __builtin_trap();
      }
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    switch (data[0] % 4) {
      case 0:
        check(read_gmsh(text, "a.msh", std::string()));  // of a wall, which has more to read
        break;
      case 1:
        check(read_tecplot(text, "a.dat"));
        break;
      case 2:
        check(read_ucd(text, "a.inp"));
        break;
      default:
        check(read_su2(text, "a.su2"));
        break;
    }
  } catch (const Error&) {
  }
  return 0;
}
