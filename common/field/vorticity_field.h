/// The vorticity of a vector field as a continuous field of its own.
///
/// The Jacobian of a linear or trilinear interpolant jumps from cell to cell, and what is felt of it would
/// buzz. Here it is brought to the points first, as finite elements recover gradients (Hinton and Campbell
/// 1974; exact where v is linear), and interpolated as v itself is:
///
///   tetrahedra    omega_i = sum_c V_c curl v|_c / sum_c V_c       over the cells c at point i, V_c volumes
///   boxes         omega_i = mean_c curl v|_c(x_i)                 on a uniform grid the central difference
///   formulas      exact
#pragma once

#include <memory>

#include "common/field/sample.h"
#include "common/field/vector_field.h"

namespace palpate {

class VorticityField {
 public:
  /// Visits every cell once. Cells with bad data or without volume say nothing; a point of such cells alone
  /// has no vorticity, and cells that have such a point are bad data here.
  explicit VorticityField(std::shared_ptr<const VectorField> field);

  /// omega at `x` in data coordinates, data units [1 / time]; status as that of the field. @rt Safe.
  [[nodiscard]] VectorSample sample(const Vec3& x_data, CellHint& hint) const noexcept;

 private:
  void recover_on_boxes();
  void recover_on_tetrahedra();

  std::shared_ptr<const VectorField> field_;
  PointVectors values_;  ///< local speed over local length; empty for a formula
};

}  // namespace palpate
