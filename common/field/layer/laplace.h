/// Laplace's equation in a wall of tetrahedra.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "common/field/grid/tet_mesh.h"

namespace palpate {

struct WallPotential {
  /// Of the points of the mesh; NaN where cells with a volume join a point to no given value.
  std::vector<double> values;
  std::size_t thin_cells = 0;  ///< too thin to have a say
  std::size_t beyond =
      0;  ///< points where obtuse cells led out of the range of the given values: brought back
  double farthest = 0.0;  ///< by how much at most
  int iterations = 0;
  double residual = 0.0;  ///< |b - A u| / |b| at the end
};

/// Solves Laplace's equation with linear finite elements: u is `given` at the points where that is not NaN, and
/// nothing flows through the rest of the border.
/// @throws Error (work failed) with `file` where the iteration does not converge.
[[nodiscard]] WallPotential solve_laplace(const TetMesh& mesh, std::span<const double> given,
                                          const std::string& file, int threads = 0);

}  // namespace palpate
