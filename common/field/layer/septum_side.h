/// The side of a septum in a right ventricle.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/field/layer/wall_border.h"
#include "common/field/layer/wall_surfaces.h"

namespace palpate {

/// A part of the border that is of a right cavity.
struct RightPart {
  std::span<const std::uint32_t> triangles;
  double area = 0.0;            ///< frame L
  bool one_of_several = false;  ///< creases part its cavity: most of a part says what all of it is
};

struct SeptumSide {
  std::vector<bool> septum;  ///< of each triangle of the border
  double area = 0.0;         ///< of these, frame L
  bool mixed =
      false;  ///< most of the parts are neither septum nor free wall as a whole: no crease says where one ends
};

/// Triangles of right cavities from which the straight way through the wall ends in the left one.
/// @param roles of the border's triangles, kRight on all of `parts`.
[[nodiscard]] SeptumSide find_septum_side(const TetMesh& mesh, const WallBorder& border,
                                          std::span<const BorderRole> roles,
                                          std::span<const RightPart> parts);

}  // namespace palpate
