/// Directions of a heart's wall at the points of its mesh.
///
/// The depth s is linear in each tetrahedron, so its gradient is a constant there and jumps at faces. At a
/// point it is the volume-weighted mean of those around (Ikits 2006, sec. 8.2 names a central difference, and
/// there is none on tetrahedra); between points its interpolant is continuous. It gives directions only:
/// places are kept on layers by the gradient of the cell.
///
///   e_t = grad s / |grad s|,   e_c = a x e_t / |a x e_t|,   e_l = e_t x e_c                              (1)
///
/// with the long axis a from apex to base: e_c runs counter-clockwise as seen from the base, e_l towards the
/// base.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "common/field/grid/tet_mesh.h"
#include "common/field/scalar_field.h"
#include "common/math/vec.h"

namespace palpate {

/// The direction of the smoothed gradient of a scalar on tetrahedra.
class SmoothNormals {
 public:
  /// @pre layer->tet_mesh().
  explicit SmoothNormals(std::shared_ptr<const ScalarField> layer);

  /// Unit, towards higher values, frame L; zero where the gradient has none. @pre 0 <= point < point count.
  [[nodiscard]] const Vec3f& at_point(std::size_t point) const noexcept { return normals_[point]; }
  /// Their interpolant at a place in a cell: shorter than one where they differ. @rt Safe.
  [[nodiscard]] Vec3 at(const TetPoint& place) const noexcept;
  [[nodiscard]] const ScalarField& layer() const noexcept { return *layer_; }

 private:
  std::shared_ptr<const ScalarField> layer_;
  std::vector<Vec3f> normals_;
};

/// The long axis, from apex to base, data coordinates: unit. It is the mean outward normal of the rim, which
/// is where the border of the mesh runs through the wall and not along it: the base, where a ventricle is cut
/// open. None where there is no rim, or its normals cancel.
[[nodiscard]] std::optional<Vec3> long_axis(const ScalarField& layer);

/// Circumferential, longitudinal and transmural direction: the columns e_c, e_l, e_t of (1).
/// @param axis, transmural of any length.
/// @return nothing where either is zero or they are parallel, as at the apex.
[[nodiscard]] std::optional<Mat3> wall_axes(const Vec3& axis, const Vec3& transmural) noexcept;

}  // namespace palpate
