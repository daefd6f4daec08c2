/// Derivatives of scalar fields by central differences of their values, data units.
///
/// The derivatives of an interpolant leap from cell to cell (on tetrahedra its gradient is constant in each,
/// and its Hessian zero). Those of its differences over a fixed spacing h do not: they are as continuous as
/// the values, and of second order in h, which is about the distance of the data's points.
#pragma once

#include "common/field/sample.h"
#include "common/field/scalar_field.h"
#include "common/math/jet.h"

namespace palpate {

/// h: the edge of a cube that holds one point of the grid on average; 2^-10 of the diagonal for a formula.
[[nodiscard]] double stencil_spacing(const ScalarField& field) noexcept;

/// The gradient, 6 samples; their status where one of them is not good, and zero then. @rt Safe.
[[nodiscard]] VectorSample difference_gradient(const ScalarField& field, const Vec3& x_data, double spacing,
                                               CellHint& hint) noexcept;

/// Value, gradient and Hessian, 19 samples. @return as difference_gradient(); `jet` is zero then. @rt Safe.
[[nodiscard]] SampleStatus difference_jet(const ScalarField& field, const Vec3& x_data, double spacing,
                                          CellHint& hint, Jet3& jet) noexcept;

}  // namespace palpate
