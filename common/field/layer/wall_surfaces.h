/// The inner and the outer surface of a wall.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/field_grid.h"

namespace palpate {

/// The point array by which a file says which surface a point lies on, by tag_of(): 1 inner, 2 outer, of two ventricles
/// also 3 right endocardium and 4 septum on the right, 5 base.
inline constexpr const char* kSurfaceArray = "surface";
/// Where the depth is given.
enum class WallSurface : std::uint8_t { kNone = 0, kInner = 1, kOuter = 2 };

/// What a triangle of the border is part of.
enum class BorderRole : std::uint8_t {
  kLeft,    ///< none of them: too small a part
  kOuter,   ///< epicardium
  kInner,   ///< of the only cavity, or of the left ventricle's
  kRight,   ///< of another cavity, where the wall behind it ends at the outer surface
  kSeptum,  ///< of another cavity, where the wall behind it ends in the left ventricle: counts as outer
  kBase     ///< where the wall is cut: no surface
};
inline constexpr int kBorderRoleCount = 6;
/// The number of a role in files; 0: none. And what a number means.
[[nodiscard]] int tag_of(BorderRole role) noexcept;
[[nodiscard]] BorderRole role_of_tag(int tag) noexcept;
/// "epicardium", "base", …
[[nodiscard]] const char* name_of(BorderRole role) noexcept;

struct WallSurfaces {
  std::vector<WallSurface> of_point;                    ///< of the grid's points
  std::string note;                                     ///< how they were found, for the user
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of the border: points of the grid, outwards
  std::vector<BorderRole> roles;                        ///< of each triangle
  std::array<double, kBorderRoleCount> areas{};         ///< in the data's unit of length, squared
  std::array<std::size_t, kBorderRoleCount> pieces{};   ///< that hang together, of 1 % of the border at least
  double confidence = 1.0;                              ///< the part of the border's area that has a role
  std::vector<std::string> doubts;                      ///< what the user should look at

  /// Whether some triangle has the role.
  [[nodiscard]] bool has(BorderRole role) const noexcept {
    return areas[static_cast<std::size_t>(role)] > 0.0;
  }
};

/// Takes them from the array kSurfaceArray where `mesh` has it: triangles whose points all have one tag are of that
/// surface (a cavity of inner points counts as the left one's), others are base where they face the way in which the outer
/// surface opens. Else from the shape of the border, which is parted where it bends by more than 40 degrees (30 or 20, where that tells no surfaces or no base, which is
/// a doubt). Parts below 1 % of its area have no role. Of the others
/// - the one with the largest extent that is not flat is the outer surface, and so are those beside it that
///   bulge outwards (BorderPart::bulge);
/// - rings between the outer surface and a part that is no further joined to it, flat ones, those that neither bulge nor lie along the wall, and those beside the outer surface that face
///   the way in which it opens are the base: flat, slanted, a saddle or jagged;
/// - the rest, by what hangs together, are cavities. Of several the roundest one is the left ventricle's
///   (volume squared over the cube of its area). Where the straight way through the wall from another one
///   ends in it, there is the septum, whose side counts as outer, so that the septum, too, runs from 0 to 1
///   (as Bayer et al., Ann Biomed Eng 40 (2012) 2243, and universal ventricular coordinates have it: Bayer
///   et al., Med Image Anal 45 (2018) 83).
/// Small parts that hang together from the outer surface to an inner one are base, too: a jagged rim. Where no part is
/// curved, as in a box, sides that meet in re-entrant edges are a cavity's, what meets them over another edge is base,
/// and the rest is outer.
/// The border of voxels is stairs and has no such parts: wall_stairs.h says what cavities, rims and normals are, which is
/// a doubt. Where that of other cells is doubtful in a way that may make all of it wrong, cavities are found likewise, in
/// a lattice that is laid over the cells, and count where no more is doubtful then. Of two cavities about as round as each
/// other the left one is that with the thicker wall.
/// @throws Error (bad input) with `file` where there are not both: "name them in a point array 'surface'".
[[nodiscard]] WallSurfaces find_wall_surfaces(const FieldGrid& grid, const DataSet& mesh,
                                              const std::string& file);

/// The depth that is given at the points of the surfaces: 0 and 1; NaN elsewhere.
[[nodiscard]] std::vector<double> depths_on(const WallSurfaces& surfaces);

/// Gives `value` to the points of the triangles that have a role. @param given of the grid's points.
void give_on(const WallSurfaces& surfaces, BorderRole role, double value, std::vector<double>& given);

/// What the user is told of them: how they were found, and a WARNING for each doubt.
[[nodiscard]] std::vector<std::string> notes_of(const WallSurfaces& surfaces);

}  // namespace palpate
