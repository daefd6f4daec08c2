/// Isosurfaces of a scalar field as a hand meets them: where a path crosses one, and the closest point on it.
///
/// The isosurface of level s_0 is the border between {s < s_0} and {s >= s_0} of the *interpolant*: on
/// tetrahedra a polygon a cell, on trilinear cells a piece of a cubic surface a cell, of a formula the
/// formula's. It is continuous everywhere and has creases where it passes from cell to cell. By the choice of
/// sides it is well-defined where data is equal to s_0 at whole faces and plateaus, too.
///
/// settle() goes from a point of the surface downhill in the distance from x to a local minimum, so it finds
/// the sheet that it comes from, never another one, and stays on the surface all the way. Ikits 2006, eqs.
/// 6.16 and 6.17, projects x on the tangent plane and returns to the surface along the gradient: where the
/// surface bends, what that converges to is on the surface but not the closest point, and where the plane
/// leads far away it is another sheet. Here the distance falls with every step:
///
///   tetrahedra  the closest point of a cell's polygon is exact; from there on to that cell around it in
///   which
///               a nearer point lies, until there is none
///   other cells Newton steps on the surface's own minimum condition x - p = lambda grad s, each brought back
///   to
///               the surface (eq. 6.16) within a bracket, cut at the cell's faces; on faces and edges the
///               steepest way down among all cells around leads on, and where none does the crease holds the
///               point
///
/// All in frame L and local values (scalar_field.h). Everything is immutable; calls from several threads are
/// fine.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

#include "common/field/scalar_field.h"
#include "common/math/vec.h"

namespace palpate {

/// Isosurfaces of interest, local values.
struct SurfaceLevels {
  static constexpr int kMax = 8;
  std::array<double, kMax> value{};
  int count = 0;
};

/// Work that may be done, counted in cells visited and steps tried; the first cell of a search is free.
struct SearchWork {
  int limit = 0;
  int used = 0;

  [[nodiscard]] bool spent() const noexcept { return used >= limit; }
  /// Counts one more. False where nothing is left.
  [[nodiscard]] bool take() noexcept {
    if (spent()) return false;
    ++used;
    return true;
  }
};

/// A place on a path through the field, and on which side of each level it is.
struct SurfacePath {
  Vec3 at{0.0};
  std::int64_t cell = -1;                               ///< tetrahedra: where `at` lies, as far as known
  std::array<std::int8_t, SurfaceLevels::kMax> side{};  ///< 1: s >= level, -1: s < level, 0: not known
};

/// A point of an isosurface.
struct SurfacePoint {
  Vec3 position{0.0};
  double level = 0.0;
  std::int64_t cell = -1;  ///< tetrahedra: the cell in which it lies
};

/// How a search for the closest point ended.
enum class SurfaceEnd : std::uint8_t {
  kClosest,  ///< at a local minimum of the distance, perhaps at the border of the data
  kBudget,   ///< the work is spent: on the surface, on the way to the minimum
  kFlat,     ///< the gradient vanishes, so that the surface has no direction there
  kBadData   ///< the surface goes on into data that is not finite
};

/// What is known at the point that was found.
struct SurfaceFit {
  SurfaceEnd end = SurfaceEnd::kClosest;
  Vec3 gradient{0.0};   ///< of s in the cell of the point
  double error = 0.0;   ///< s - s_0 there
  double toward = 0.0;  ///< sign: whether s rises (1) or falls (-1) from the point towards x; 0 where it is x
  Mat3 jacobian{0.0};   ///< how the point moves with x
};

class IsosurfaceSearch {
 public:
  IsosurfaceSearch() = default;
  IsosurfaceSearch(const IsosurfaceSearch&) = delete;
  IsosurfaceSearch& operator=(const IsosurfaceSearch&) = delete;
  virtual ~IsosurfaceSearch() = default;

  /// Moves `path` straight to `to`, or as far as the first place where it changes its side of a level:
  /// returns the index of that level, or -1. Every crossing is found, however far the step and thin what it
  /// crosses; but what comes from outside the data, or from bad data, has no side before its first place
  /// inside. With the work spent the path ends where it has come to. @rt Safe.
  [[nodiscard]] virtual int advance(SurfacePath& path, const Vec3& to, const SurfaceLevels& levels,
                                    SearchWork& work) const noexcept = 0;

  /// Moves `point`, which lies on the isosurface of its level (to some rounding), to the local minimum of the
  /// distance from `x`. The same `x` again does not move it, where the work was enough. @rt Safe.
  [[nodiscard]] virtual SurfaceFit settle(const Vec3& x, SurfacePoint& point,
                                          SearchWork& work) const noexcept = 0;
};

/// @pre `field` has values. The search keeps it.
[[nodiscard]] std::unique_ptr<const IsosurfaceSearch> make_isosurface_search(
    std::shared_ptr<const ScalarField> field);

/// Thresholds of the isosurface searches, relative to the size and the values of a field.
struct IsosurfaceScale {
  double distance = 0.0;  ///< frame L: what rounding moves a point
  double value = 0.0;     ///< local: what rounding changes a value
  double flat = 0.0;      ///< local: a cell over which s changes by less has no gradient
  double diagonal = 0.0;  ///< frame L

  explicit IsosurfaceScale(const ScalarField& field) {
    const double to_local = power_of_two(-field.frame().length_exponent);
    const Vec3 farthest = glm::max(glm::abs(field.bounds().lower), glm::abs(field.bounds().upper)) * to_local;
    diagonal = field.diagonal() * to_local;
    distance = 0x1p-50 * std::max({farthest.x, farthest.y, farthest.z, diagonal});
    const double largest =
        std::max(std::abs(field.lowest()), std::abs(field.highest())) * field.value_scale();
    value = 0x1p-50 * largest;
    flat = 0x1p-40 * field.local_range();
  }

  /// A path has changed sides when it is beyond the level by more than this.
  [[nodiscard]] double beyond() const noexcept { return 0x1p6 * value; }
};

}  // namespace palpate
