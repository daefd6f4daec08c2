/// Lenses: convex regions of a volume that are drawn in a way of their own.
///
/// A shape is the intersection of at most one quadric and of half-spaces, in data coordinates:
///
///   |M (x - c)| <= 1   and   n_i . x <= h_i for all i                                            (1)
///
/// M of rank three gives an ellipsoid, of rank two an elliptic cylinder without ends. A line meets a convex
/// shape in one interval (lens_segments in shaders/volume/), so a ray is split into context, focus, context
/// (Ikits 2006, sec. 5.3). Of several lenses the first in the list wins where they overlap.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "common/field/transfer/color_transfer.h"
#include "common/field/transfer/region_transfer.h"
#include "common/math/vec.h"

namespace palpate {

struct ConvexShape {
  struct Quadric {
    Mat3 unit_from_data{1.0};  ///< M
    Vec3 center{0.0};          ///< c

    bool operator==(const Quadric&) const = default;
  };
  struct HalfSpace {
    Vec3 outward{0.0, 0.0, 1.0};  ///< n, unit
    double offset = 0.0;          ///< h [data units]

    bool operator==(const HalfSpace&) const = default;
  };
  std::optional<Quadric> quadric;
  std::vector<HalfSpace> half_spaces;

  [[nodiscard]] bool contains(const Vec3& x) const noexcept;
  bool operator==(const ConvexShape&) const = default;
};

/// Where the line x(t) = origin + t direction runs inside; empty where `first` >= `last`.
struct LineInterval {
  double first = 0.0;
  double last = 0.0;
};
[[nodiscard]] LineInterval clip_line(const ConvexShape& shape, const Vec3& origin,
                                     const Vec3& direction) noexcept;

/// @pre for all shapes: finite numbers, sizes >= 0, directions that are not zero. A shape of no size holds no
/// more than a set of measure zero, and is not seen.
[[nodiscard]] ConvexShape make_sphere(const Vec3& center, double radius);
/// @param axes columns: from the centre to the middles of three faces, at right angles to each other.
[[nodiscard]] ConvexShape make_box(const Vec3& center, const Mat3& axes);
[[nodiscard]] ConvexShape make_cylinder(const Vec3& from, const Vec3& to, double radius);
/// The tetrahedron, pyramid or other polyhedron that half-spaces enclose; normals need not be unit.
[[nodiscard]] ConvexShape make_polyhedron(std::span<const ConvexShape::HalfSpace> faces);

/// The middle of a ball, box or cylinder, the mean of the corners of another polyhedron; of a half-space the
/// point of its border nearest to `near`, which stands also where there are no corners.
[[nodiscard]] Vec3 center_of(const ConvexShape& shape, const Vec3& near) noexcept;
/// The shape moved by `shift` [data units].
[[nodiscard]] ConvexShape moved(ConvexShape shape, const Vec3& shift) noexcept;
/// The shape grown about center_of(); half-spaces have no size. @pre finite, factor > 0.
[[nodiscard]] ConvexShape scaled(ConvexShape shape, double factor) noexcept;

inline constexpr std::size_t kMostLenses = 1024;    ///< of one picture
inline constexpr std::size_t kMostHalfSpaces = 32;  ///< of one lens

/// A circle on the screen, in heights of the picture from its middle: x to the right, y up.
struct ScreenCircle {
  double x = 0.0, y = 0.0;
  double radius = 0.25;  ///< > 0

  [[nodiscard]] bool holds(double at_x, double at_y) const noexcept;
  bool operator==(const ScreenCircle&) const = default;
};

struct Lens {
  ConvexShape shape;
  /// Where present, the lens is what `shape` holds of the rays through this circle, be the volume turned or
  /// not; a shape without quadric and half-spaces holds all of them.
  std::optional<ScreenCircle> screen;
  std::optional<ColorTransfer> transfer;  ///< absent: that of the context
  std::optional<RegionTransfer> regions;  ///< in place of `transfer`, of value and gradient magnitude
  bool own_transfer = false;              ///< they are its own, not those of all lenses of a window
  /// Which of the scene's scalars is shown (VolumeView::fields): 0 is that of the context.
  std::size_t field = 0;
  double samples_per_voxel = 4.0;  ///< > 0
  bool shading = true;
  bool illustrated = false;  ///< as VolumeView::illustrated
  bool cut = false;          ///< cut away: nothing is drawn inside
  /// Colours are those of the voxels, in the context's field; the transfer function gives opacities alone.
  bool colored = false;
  /// >= 1: matter about center_of() is seen this many times as large (shaders/volume/magnify.glsl); it
  /// takes its place among its neighbours again toward the border, which stays where it is.
  double magnification = 1.0;
  /// In [0, 1]: over this share of the way from the border to center_of() values go over from those of the
  /// coarser voxels outside (ContextQuality::level) to the lens's own, before they have a colour; 0: at once.
  double transition = 0.0;

  bool operator==(const Lens&) const = default;
};

/// Whether the lens enlarges: cut away, without bounds, without room about its middle or on the screen it
/// does not.
[[nodiscard]] bool magnifies(const Lens& lens);
/// Whether values go over at its border: as for magnifies(), but on the screen they do, too; where the lens
/// enlarges or shows another field they do not.
[[nodiscard]] bool has_transition(const Lens& lens);

/// The corners of the polygon in which the border of `plane` meets all of `within`, in order about its
/// normal; empty where it misses them.
/// @param near a point of the solid.
/// @param reach no point of the solid is farther than this from `near`.
/// @pre plane.outward is unit.
[[nodiscard]] std::vector<Vec3> plane_section(const ConvexShape::HalfSpace& plane,
                                              std::span<const ConvexShape::HalfSpace> within,
                                              const Vec3& near, double reach);

/// The same for a box along the axes of the data.
[[nodiscard]] std::vector<Vec3> plane_section(const ConvexShape::HalfSpace& plane, const Box& box);

}  // namespace palpate
