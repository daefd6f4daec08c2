/// Interpolation along the axes of an element: Lagrange polynomials of degree one to three, cubic Hermite ones, and
/// polynomials of degree one or two on simplices.
#pragma once

#include <array>

#include "common/math/vec.h"
#include "loaders/cardiac/ex/ex_model.h"

namespace palpate::ex {

/// Weights of the parameters along one axis at `xi` in [0, 1]: node by node, value before derivative.
struct AxisWeights {
  std::array<double, 4> value{};
  std::array<double, 4> slope{};  ///< d/dxi
  int count = 0;
};
[[nodiscard]] AxisWeights axis_weights(Basis basis, double xi) noexcept;

/// A component's value and its derivatives along the element's axes.
struct Interpolated {
  double value = 0.0;
  Vec3 slope{0.0};
};

/// @param parameters corner by corner (first axis fastest), at each corner the derivative along the first
/// axis fastest: as many as nodes (node_count()) times the product of parameter counts.
[[nodiscard]] Interpolated interpolate(const std::array<Basis, 3>& basis, const double* parameters,
                                       const Vec3& xi) noexcept;

}  // namespace palpate::ex
