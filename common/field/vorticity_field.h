/// The vorticity of a vector field as a continuous field of its own.
///
/// The Jacobian of a linear or trilinear interpolant jumps from cell to cell, and what is felt of it would
/// buzz. Here it is brought to the points first, as finite elements recover gradients (Hinton and Campbell
/// 1974; exact where v is linear), and interpolated as v itself is:
///
///   tetrahedra    omega_i = sum_c V_c curl v|_c / sum_c V_c       over the cells c at point i, V_c volumes
///   boxes         omega_i = mean_c curl v|_c(x_i)                 on a uniform grid the central difference
///   formulas      exact
///
/// It is a difference of values that nearly cancel where the flow does not turn. What is no more than the
/// rounding of these values, as they are stored, is none: 0.
#pragma once

#include <memory>

#include "common/field/sample.h"
#include "common/field/vector_field.h"
#include "common/math/vec.h"

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

// Measures derived from the velocity gradient J, J_ij = dv_i/dx_j, stored as m[j][i].
//
// With the strain rate S = (J + J^T) / 2 and the rotation rate W = (J - J^T) / 2:
//   divergence = tr J
//   vorticity  = curl v = (J_32 - J_23, J_13 - J_31, J_21 - J_12)
//   Q          = (|W|^2 - |S|^2) / 2, Frobenius norms (Hunt, Wray and Moin 1988); vortices where Q > 0
//   lambda_2   = middle eigenvalue of S^2 + W^2 (Jeong and Hussain 1995); vortices where lambda_2 < 0
// For S^2 + W^2 = (J^2 + (J^2)^T) / 2, the symmetric part of J^2, its trace is -2 Q.
//
// Jacobians of trilinear and linear interpolants are first order accurate where values are second order.

[[nodiscard]] double divergence(const Mat3& m) noexcept;
[[nodiscard]] Vec3 vorticity(const Mat3& m) noexcept;
[[nodiscard]] double q_criterion(const Mat3& m) noexcept;
[[nodiscard]] double lambda2(const Mat3& m) noexcept;

/// The scalar measures that can be asked of a vector field.
enum class Measure { kSpeed, kDivergence, kVorticityMagnitude, kQ, kLambda2 };

/// A measure of `field` at `x_data`, data units: speed; 1 / time; 1 / time; 1 / time^2; 1 / time^2.
/// @rt Safe.
[[nodiscard]] ScalarSample sample_measure(const VectorField& field, Measure measure, const Vec3& x_data,
                                          CellHint& hint) noexcept;

}  // namespace palpate
