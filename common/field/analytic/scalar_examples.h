/// Scalar formulas with a known structure, to learn on and to test against.
#pragma once

#include <memory>

#include "common/field/analytic/analytic_scalar.h"

namespace palpate {

/// |x|^2 over [-1.5, 1.5]^3: the isosurface of value r^2 is the sphere of radius r.
[[nodiscard]] std::shared_ptr<const AnalyticScalar> sphere_scalar();

/// The test signal of Marschner and Lobb 1994, f_M = 6 and alpha = 1/4, over [-1, 1]^3:
///   s = (1 - sin(pi z / 2) + alpha (1 + rho(r))) / (2 (1 + alpha)),  rho(r) = cos(2 pi f_M cos(pi r / 2)),
/// r^2 = x^2 + y^2.
[[nodiscard]] std::shared_ptr<const AnalyticScalar> marschner_lobb_scalar();

}  // namespace palpate
