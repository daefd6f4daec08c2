/// What a cavity of a wall is like: by these the left ventricle is told from the right one.
#pragma once

#include <vector>

#include "common/field/layer/wall_border.h"

namespace palpate {

/// How thick the wall is between a cavity and the outer surface, in the mean; 0 where no way through it is found.
/// @param cavity, outer of each triangle of the border whether it is in it.
[[nodiscard]] double wall_before(const TetMesh& mesh, const WallBorder& border,
                                 const std::vector<bool>& cavity, const std::vector<bool>& outer);

/// 36 pi V^2 / A^3 of a cavity closed at the middle of its rim: 1 for a sphere.
[[nodiscard]] double roundness(const TetMesh& mesh, const WallBorder& border,
                               const std::vector<bool>& cavity);

}  // namespace palpate
