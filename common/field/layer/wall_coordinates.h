/// Coordinates of the wall of a ventricle, or of two: where in it a point lies, whatever its shape. No fibres are
/// needed.
///
///   transmural   Laplace's equation from the inner (0) to the outer surface (1); the right side of a septum
///                counts as outer
///   apicobasal   from the apex (0) to the base (1): Laplace's equation between both gives the ways, and the value
///                is the length of the way from the apex over that of the whole way
///   rotational   angle about the long axis, in (-pi, pi], counter-clockwise as seen from the base; of two
///                ventricles 0 is the middle of the septum, else the first coordinate axis that leads away
///   ventricle    -1 left with the septum, 1 right
///
/// Transmural and apicobasal depth, ventricle, and their ranges are those of universal ventricular coordinates
/// (Bayer et al., Med Image Anal 45 (2018) 83); lengths in place of a potential that has a pole at the apex are
/// theirs, too, and Schuler et al.'s, Med Image Anal 74 (2021) 102247. The rotational coordinate is the angle
/// itself in place of Laplace's equation between the sides of a cut: both are one in a wall that is round.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/field/field_grid.h"
#include "common/field/layer/wall_surfaces.h"

namespace palpate {

/// The long axis of a left ventricle, and the potential between its apex and its base.
struct WallAxis {
  Vec3 middle{0.0};     ///< of the opening of the left cavity, data coordinates
  Vec3 direction{0.0};  ///< unit, from apex to base
  /// Points of the grid through the wall, from the inner to the outer surface.
  std::vector<std::uint32_t> apex;
  std::vector<double> potential;  ///< 0 at the apex, 1 at the base: psi_ab of Bayer et al. 2012
};

/// The axis leads from the middle of the left endocardium's area to that of its rim. The apex are the points along
/// the shortest way over edges from the lowest point of that surface to the lowest one of the epicardium.
/// @throws Error (bad input) with `file` where there is no base, (work failed) as solve_laplace().
[[nodiscard]] WallAxis find_wall_axis(const FieldGrid& grid, const WallSurfaces& surfaces,
                                      const std::string& file, int threads = 0);

/// Of the points of the grid; NaN where a coordinate is not defined: off the mesh, on the axis.
struct WallCoordinates {
  WallAxis axis;
  std::vector<double> transmural;
  std::vector<double> apicobasal;
  std::vector<double> rotational;  ///< [rad]
  std::vector<double> ventricle;   ///< empty where there is one
  std::vector<std::string> notes;  ///< where they begin, and where they are not defined
};

/// @throws Error as find_wall_axis().
[[nodiscard]] WallCoordinates make_wall_coordinates(const FieldGrid& grid, const WallSurfaces& surfaces,
                                                    const std::string& file, int threads = 0);

}  // namespace palpate
