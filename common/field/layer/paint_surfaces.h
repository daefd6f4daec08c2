/// Surfaces of a wall as a user corrects them: balls of paint on its border.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/field_grid.h"
#include "common/field/layer/wall_surfaces.h"

namespace palpate {

/// The border in a ball is part of `role`, as far as it faces the way of the triangle that is nearest to the ball's
/// middle, within a right angle: the far side of a thin wall is not.
struct SurfacePaint {
  BorderRole role = BorderRole::kBase;
  Vec3 center{0.0};  ///< data coordinates
  double radius = 0.0;

  bool operator==(const SurfacePaint&) const = default;
};

/// "inner:x,y,z,r"; the surfaces are inner, outer, right, septum and base. @throws Error (usage).
[[nodiscard]] std::vector<SurfacePaint> parse_paint(const std::vector<std::string>& texts);
[[nodiscard]] std::string paint_text(const SurfacePaint& paint);

/// find_wall_surfaces(), painted, in the order of `paint`. Where none are found paint alone says what is what.
/// @throws Error as find_wall_surfaces(), where painting leaves no inner or no outer surface, too.
[[nodiscard]] WallSurfaces find_painted_surfaces(const FieldGrid& grid, const DataSet& mesh,
                                                 const std::string& file,
                                                 std::span<const SurfacePaint> paint);

}  // namespace palpate
