/// The closed rims of the parts of a border.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/field/layer/wall_border.h"

namespace palpate {

/// Edges of a part that hang together, and what lies beyond them.
struct PartRim {
  struct Beside {
    std::size_t part = 0;
    double length = 0.0;  ///< of the edges that both parts share, frame L
  };
  double length = 0.0;
  std::vector<Beside> beside;  ///< by number of the part
};

/// Of each part its rims, the longest first. Rims that meet in a point are one.
/// @param part_of of each triangle.
[[nodiscard]] std::vector<std::vector<PartRim>> part_rims(const TetMesh& mesh, const WallBorder& border,
                                                          std::span<const std::size_t> part_of,
                                                          std::size_t parts);

}  // namespace palpate
