/// Walls of voxels: their borders are stairs, whose normals and creases say nothing of the shape.
///
/// What a stair is part of is found in the lattice of the voxels: a cavity is what lies in most directions behind the
/// wall, as if it were closed. Normals are means over some voxels around, and a triangle stands for the part of the
/// smooth surface that it covers: its area times the cosine between its normal and that mean. The sum of those is the
/// area of the smooth surface, where that of the stairs is up to sqrt(3) times as large however small the voxels are.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/field/grid/tet_mesh.h"
#include "common/field/layer/wall_border.h"

namespace palpate {

struct WallStairs {
  static constexpr std::int32_t kOutside = -1, kRim = -2;

  double step = 0.0;  ///< longest edge of a voxel, frame L
  /// Of each triangle: the cavity that it borders, kOutside, or kRim: a cut of the wall.
  std::vector<std::int32_t> beside;
  std::vector<Vec3> areas;  ///< of each triangle: what it stands for, as WallBorder::areas
};

/// Nothing where the border is none of voxels, or no cavity is found.
[[nodiscard]] std::optional<WallStairs> find_wall_stairs(const TetMesh& mesh, const WallBorder& border);

/// The same for cells of any shape, in a lattice that is laid over them: its step is half a typical edge of the border,
/// but no more voxels than 2 million. WallStairs::areas are the border's own. Nothing where no cavity is found.
[[nodiscard]] std::optional<WallStairs> find_closed_cavities(const TetMesh& mesh, const WallBorder& border);

}  // namespace palpate
