/// Robust non-linear least squares over blocks of parameters.
///
/// Quaternions are moved by their three components of smallest magnitude, the fourth following from unit
/// length, chosen anew at every iteration: that map is well conditioned wherever the quaternion is (Ikits
/// 2006, eq. 4.14). Derivatives are central differences with a step of about 6e-6 of a parameter's size:
/// their error, some 1e-10 of the derivative, lies far below what any sensor's noise does to it.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

struct ParameterBlock {
  std::vector<double> values;
  std::vector<std::string> names;  ///< one a degree of freedom: three for a quaternion
  bool quaternion = false;         ///< values are w, x, y, z of unit length
  bool fixed = false;
};

struct ResidualBlock {
  std::vector<std::size_t> parameters;  ///< indices of the blocks that it depends on
  std::size_t dimension = 0;
  /// Writes `dimension` residuals. Called from one thread; must accept quaternions slightly off unit length.
  std::function<void(const double* const* parameters, double* residuals)> evaluate;
  bool robust = true;  ///< whether the loss applies; prior knowledge is taken as it is
};

/// Three values of a parameter block.
[[nodiscard]] inline Vec3 vector(const double* x) { return {x[0], x[1], x[2]}; }
/// Three residuals.
inline void write_residuals(double* residuals, const Vec3& x) {
  for (int axis = 0; axis < 3; ++axis) residuals[axis] = x[axis];
}

/// How measurements far from the fit count. The scale is that of a block's residual norm.
enum class Loss { kSquare, kHuber, kCauchy };

struct LeastSquaresOptions {
  Loss loss = Loss::kSquare;
  double loss_scale = 1.0;
  int max_iterations = 200;
};

struct LeastSquaresSummary {
  bool converged = false;
  int iterations = 0;
  double initial_cost = 0.0, final_cost = 0.0;  ///< half the sum of (robust) squares
  std::string message;
};

struct LeastSquaresProblem {
  std::vector<ParameterBlock> parameters;
  std::vector<ResidualBlock> residuals;
};

/// Changes the parameters' values to a local minimum.
LeastSquaresSummary minimize(LeastSquaresProblem& problem, const LeastSquaresOptions& options);

/// Derivatives of all residuals by all free degrees of freedom, without loss.
struct Linearization {
  std::size_t rows = 0, columns = 0;
  std::vector<double> jacobian;    ///< row by row
  std::vector<double> residuals;   ///< `rows` of them
  std::vector<std::string> names;  ///< of columns
};

[[nodiscard]] Linearization linearize(const LeastSquaresProblem& problem);

}  // namespace palpate
