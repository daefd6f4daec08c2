#include "common/field/cells/loose_points.h"

#include <algorithm>

#include "common/base/index.h"

namespace palpate {

std::vector<std::uint8_t> points_of_cells(const UnstructuredTopology& mesh) {
  constexpr std::uint8_t kPolyhedron = 42;  // of VTK's file format
  std::vector<std::uint8_t> used(mesh.positions.tuples, 0);
  const auto use = [&](std::int64_t point) {
    if (point >= 0 && as_size(point) < used.size()) used[as_size(point)] = 1;
  };
  for (std::size_t c = 0; c < mesh.types.size(); ++c) {
    const auto begin = as_size(mesh.offsets[c]), end = as_size(mesh.offsets[c + 1]);
    if (mesh.types[c] != kPolyhedron) {
      for (std::size_t at = begin; at < end; ++at) use(mesh.connectivity[at]);
      continue;
    }
    for (std::size_t at = begin + 1; at < end;) {
      const std::size_t last = std::min(end, at + 1 + as_size(mesh.connectivity[at]));
      for (++at; at < last; ++at) use(mesh.connectivity[at]);
    }
  }
  return used;
}

}  // namespace palpate
