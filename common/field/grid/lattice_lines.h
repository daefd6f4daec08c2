/// Rectilinear grids of uneven steps as lattices.
///
/// Symbols.  g grid coordinates, whole numbers at the points; m mean coordinates of an axis of n points: from 0 to n - 1
/// as g, but in proportion to lengths, hence x = origin + axes m with the mean steps as columns of `axes`. g(m) is linear
/// between points, so that values trilinear in g are trilinear in space within each cell.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "common/field/data_set.h"
#include "common/math/vec.h"

namespace palpate {

/// Where the points of a lattice of uneven steps lie along its axes.
struct LatticeLines {
  /// Of each axis m of its points, rising from 0 to n - 1; empty where steps are even.
  std::array<std::vector<double>, 3> at;

  /// g of a place in m; beyond the ends the outermost steps go on.
  [[nodiscard]] Vec3 grid(const Vec3& mean) const noexcept;
  /// m of a place in g, likewise.
  [[nodiscard]] Vec3 mean(const Vec3& grid) const noexcept;
  /// The shortest step of an axis, in m.
  [[nodiscard]] double finest(int axis) const noexcept;
};

/// A lattice and its lines; null: its steps are even.
struct UnevenLattice {
  UniformTopology mean;
  std::shared_ptr<const LatticeLines> lines;
};
/// Axes of one point step by 1. Steps that differ by no more than `rounding` of the mean one are even.
[[nodiscard]] UnevenLattice uneven_lattice(const RectilinearTopology& grid, double rounding = 0.0);

}  // namespace palpate
